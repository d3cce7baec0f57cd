#include "bakerd/trace/surface.h"

#include "bakerd/map/texture.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace drtv::trace {
namespace {

template <class Value>
Value interpolate(const std::vector<Value>& values, const glm::uvec3& t, float u, float v) {
    return values[t.x] * (1 - u - v) + values[t.y] * u + values[t.z] * v;
}

glm::vec4 colour_at(const map::Map& map, const map::Primitive& primitive, std::uint32_t triangle, float u, float v) {
    const map::Material& material = map.materials[primitive.material];
    const glm::uvec3& t = primitive.triangles[triangle];
    glm::vec4 colour = material.base_colour;
    if (!primitive.colours.empty()) colour *= interpolate(primitive.colours, t, u, v);
    if (material.texture != map::no_texture) {
        const glm::vec3 uv(interpolate(primitive.uvs, t, u, v), 1);
        colour *= map::sample(map.textures[material.texture], {glm::dot(material.texture_u_from_uv, uv), glm::dot(material.texture_v_from_uv, uv)});
    }
    return colour;
}

}  // namespace

float alpha_at(const map::Map& map, const map::Primitive& primitive, std::uint32_t triangle, float u, float v) { return colour_at(map, primitive, triangle, u, v).w; }

glm::vec3 albedo_at(const map::Map& map, const map::Primitive& primitive, std::uint32_t triangle, float u, float v) {
    return glm::clamp(glm::vec3(colour_at(map, primitive, triangle, u, v)), 0.0f, map::max_albedo);
}

}  // namespace drtv::trace
