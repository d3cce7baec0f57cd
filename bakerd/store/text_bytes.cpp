#include "bakerd/store/text_bytes.h"

#include <nlohmann/json.hpp>

namespace drtv::store {

std::string as_utf8(std::string_view text) {
    using Json = nlohmann::json;
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

}  // namespace drtv::store
