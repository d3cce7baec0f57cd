#include "bakerd/bake/shown_names.h"

#include <fmt/format.h>

namespace drtv::bake {

std::string shown_name(const std::string& name, const char* kind) {
    return name.empty() ? fmt::format("{} without a name", kind) : fmt::format("'{}'", name);
}

std::string shown_object(const map::Map& map, std::uint32_t object) {
    return shown_name(map.objects[object].name, "an object");
}

std::string shown_place(const glm::dvec3& place) {
    return fmt::format("({:.2f}, {:.2f}, {:.2f})", place.x, place.y, place.z);
}

}  // namespace drtv::bake
