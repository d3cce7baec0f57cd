#include "bakerd/map/light_import.h"

#include "bakerd/map/gltf_document.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace drtv::map {

tl::expected<Light, std::string> import_light(const tinygltf::Model& model, int number) {
    const tinygltf::Light& source = at_index(model.lights, number);
    const auto fail = [&](const std::string& rest) {
        return tl::unexpected(fmt::format("light {}: {}", number, rest));
    };
    Light light;
    if (source.type == "spot")
        light.kind = LightKind::spot;
    else if (source.type == "directional")
        light.kind = LightKind::directional;
    else if (source.type != "point")
        return fail(fmt::format("type '{}' is unknown", source.type));
    for (std::size_t k = 0; k < 3 && k < source.color.size(); ++k)
        light.colour[static_cast<glm::length_t>(k)] = static_cast<float>(source.color[k]);
    light.intensity = static_cast<float>(source.intensity);
    light.range_m = static_cast<float>(source.range);
    if (light.kind == LightKind::spot) {
        light.inner_cone_radians = static_cast<float>(source.spot.innerConeAngle);
        light.outer_cone_radians = static_cast<float>(source.spot.outerConeAngle);
    }
    for (float value : {light.colour.x,
                        light.colour.y,
                        light.colour.z,
                        light.intensity,
                        light.range_m,
                        light.inner_cone_radians,
                        light.outer_cone_radians}) {
        if (!(value >= 0 && std::isfinite(value)))
            return fail(fmt::format("{} is not a colour, an intensity, a range or an angle", value));
    }
    constexpr float max_intensity = 1e12f;
    if (light.intensity > max_intensity)
        return fail(fmt::format("intensity {} is over the limit of {}", light.intensity, max_intensity));
    if (light.inner_cone_radians > light.outer_cone_radians ||
        light.outer_cone_radians > std::numbers::pi_v<float> / 2) {
        return fail(fmt::format("cone angles {} and {} do not lie one in the other and below pi/2",
                                light.inner_cone_radians,
                                light.outer_cone_radians));
    }
    return light;
}

// Many exported scenes have a sun, from the modeller's own view of them.
std::string doubt_about(const Light& light) {
    if (light.kind != LightKind::directional || !shines(light))
        return "";
    const std::string name = light.name.empty() ? "a light" : fmt::format("the light '{}'", light.name);
    return name +
           " is directional: it is baked as a sun that never moves. Leave it out, with bake_role "
           "'ignore', where the game has its own";
}

}  // namespace drtv::map
