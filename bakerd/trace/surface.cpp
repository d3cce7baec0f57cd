#include "bakerd/trace/surface.h"

#include "bakerd/map/colour.h"
#include "bakerd/map/texture.h"
#include "bakerd/trace/surface_point.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace drtv::trace {
namespace {

// A texel is never wider than this part of a triangle. What a picture holds beside the part that a surface
// wears must not bleed in: with texels as wide as the footprint alone, Sponza came out 1.3 % too dark.
constexpr float texels_a_triangle = 16;

// The mip level at which one texel is as wide as the footprint, from the texels and the square metres of the
// triangle.
std::uint32_t mip_level(const map::Texture& texture,
                        const std::array<glm::vec2, 3>& uvs,
                        const RayFootprint& footprint) {
    const glm::vec2 a = uvs[1] - uvs[0];
    const glm::vec2 b = uvs[2] - uvs[0];
    const float double_texels = std::abs(a.x * b.y - a.y * b.x) * static_cast<float>(texture.width) *
                                static_cast<float>(texture.height);
    const float ratio = std::min(footprint.width_m * footprint.width_m / footprint.double_area_m2,
                                 1 / (2 * texels_a_triangle * texels_a_triangle)) *
                        double_texels;
    if (!(ratio > 1))
        return 0;
    return ((std::bit_cast<std::uint32_t>(ratio) >> 23) - 127 + 1) / 2;  // half the logarithm, rounded
}

glm::vec3 filtered(const TrianglePoint& point,
                   const map::TextureView& view,
                   const std::vector<glm::vec2>& uvs,
                   const RayFootprint& footprint) {
    const map::Texture& texture = point.map.textures[view.texture];
    const glm::uvec3& t = point.corners();
    const std::array<glm::vec2, 3> corners = {
        viewed(view, uvs[t.x]), viewed(view, uvs[t.y]), viewed(view, uvs[t.z])};
    const glm::vec2 at = corners[0] * (1 - point.u - point.v) + corners[1] * point.u + corners[2] * point.v;
    return map::sample_filtered(texture, at, mip_level(texture, corners, footprint));
}

bool is_leaf(const map::Material& material, map::Role role) {
    return role == map::Role::vegetation &&
           (material.double_sided || material.alpha_mode != map::AlphaMode::opaque);
}

}  // namespace

float max_scattered(const map::Map& map) {
    std::set<std::pair<std::uint32_t, bool>> seen;  // meshes, as vegetation or not
    std::map<std::uint32_t, glm::vec3> of_textures;
    float most = min_scattered;
    for (const map::Object& object : map.objects) {
        const bool vegetation = object.role == map::Role::vegetation;
        if (!seen.insert({object.mesh, vegetation}).second)
            continue;
        for (const map::Primitive& primitive : map.meshes[object.mesh].primitives) {
            const map::Material& material = map.materials[primitive.material];
            const auto scattered = [&](const glm::vec3& colour) {
                const float albedo = std::min(map::brightest(colour), map::max_albedo);
                if (material.diffuse_transmission > 0)
                    return albedo * (1 - material.diffuse_transmission) +
                           std::min(map::brightest(material.diffuse_transmission_colour) *
                                        material.diffuse_transmission,
                                    map::max_albedo);
                return is_leaf(material, object.role)
                           ? std::min(albedo * (1 + leaf_transmission), map::max_albedo)
                           : albedo;
            };
            glm::vec3 colour(material.base_colour);
            if (!primitive.colours.empty()) {
                glm::vec3 largest(0);
                for (const glm::vec4& vertex : primitive.colours)
                    largest = glm::max(largest, glm::vec3(vertex));
                colour *= largest;
            }
            // Textures are looked at only where they matter: their colours are 1 at most.
            if (scattered(colour) <= most)
                continue;
            if (material.base_texture.present()) {
                const std::uint32_t texture = material.base_texture.texture;
                const auto [entry, added] = of_textures.try_emplace(texture);
                if (added)
                    entry->second = map::brightest_of_all(map.textures[texture]);
                colour *= entry->second;
            }
            most = std::max(most, scattered(colour));
        }
    }
    return most;
}

glm::vec3 emission_at(const TrianglePoint& point, const RayFootprint& footprint) {
    const map::Material& material = point.material();
    if (!material.emission_texture.present())
        return material.emission;
    return material.emission *
           filtered(point, material.emission_texture, point.primitive.emission_uvs, footprint);
}

Surface surface_at(const TrianglePoint& point, map::Role role, bool front, const RayFootprint& footprint) {
    const map::Primitive& primitive = point.primitive;
    const map::Material& material = point.material();
    if (!front && !is_two_sided(material, role))
        return {true, glm::vec3(0), glm::vec3(0), glm::vec3(0)};

    glm::vec3 colour(material.base_colour);
    if (!primitive.colours.empty())
        colour *= glm::vec3(interpolate(primitive.colours, point));
    if (material.base_texture.present())
        colour *= filtered(point, material.base_texture, primitive.uvs, footprint);
    Surface surface;
    surface.albedo = glm::clamp(colour, 0.0f, map::max_albedo);
    if (material.diffuse_transmission > 0) {
        surface.transmitted = material.diffuse_transmission_colour * material.diffuse_transmission;
        surface.albedo *= 1 - material.diffuse_transmission;
    } else if (is_leaf(material, role)) {
        surface.transmitted = surface.albedo * leaf_transmission;
    }
    if (material.transmission > 0) {
        // Of what is there no light goes straight on any more: that is where it is not there (is_there).
        const float clear = clear_share(point);
        const float there = 1 - clear * map::brightest(unfiltered_colour(point));
        const float scattered = there > 0 ? (1 - clear) / there : 0;
        surface.albedo *= scattered;
        surface.transmitted *= scattered;
    }
    const glm::vec3 total = surface.albedo + surface.transmitted;
    for (glm::length_t k = 0; k < 3; ++k) {
        if (total[k] <= map::max_albedo)
            continue;
        surface.albedo[k] *= map::max_albedo / total[k];
        surface.transmitted[k] *= map::max_albedo / total[k];
    }
    if (material.emission != glm::vec3(0) && (front || material.double_sided))
        surface.emission = emission_at(point, footprint);
    return surface;
}

}  // namespace drtv::trace
