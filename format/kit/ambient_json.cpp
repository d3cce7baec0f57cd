#include "ambient_json.h"

namespace drtv::kit {

void append_parts(JsonWriter& json, const AmbientParts& parts) {
    json.key("parts").begin_object();
    json.key("sky_direct").array(parts.sky_direct);
    json.key("sky_bounce").array(parts.sky_bounce);
    json.key("sun_bounce").array(parts.sun_bounce);
    json.key("static").array(parts.static_light);
    json.key("local").array(parts.local);
    json.key("fallback").array(parts.fallback);
    json.end_object();
}

void append_reference(JsonWriter& json, const char* key, const LoadedSector* sector, std::uint32_t index) {
    json.key(key);
    if (sector == nullptr) {
        json.null();
        return;
    }
    json.begin_object().key("sector").begin_array().value(sector->view.i).value(sector->view.j).end_array();
    json.member("index", index);
    json.end_object();
}

}  // namespace drtv::kit
