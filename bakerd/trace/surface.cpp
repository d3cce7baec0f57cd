#include "bakerd/trace/surface.h"

#include "bakerd/map/colour.h"
#include "bakerd/map/mixed_bits.h"
#include "bakerd/map/texture.h"

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

template <class Value>
Value interpolate(const std::vector<Value>& values, const TrianglePoint& point) {
    const glm::uvec3& t = point.corners();
    return values[t.x] * (1 - point.u - point.v) + values[t.y] * point.u + values[t.z] * point.v;
}

glm::vec2 viewed(const map::TextureView& view, const glm::vec2& uv) {
    const glm::vec3 row(uv, 1);
    return {glm::dot(view.u_from_uv, row), glm::dot(view.v_from_uv, row)};
}

// A texel is never wider than this part of a triangle. What a picture holds beside the part that a surface
// wears must not bleed in: with texels as wide as the footprint alone, Sponza came out 1.3 % too dark.
constexpr float texels_a_triangle = 16;

// The mip level at which one texel is as wide as the footprint, from the texels and the square metres of the
// triangle.
std::uint32_t mip_level(const map::Texture& texture,
                        const std::array<glm::vec2, 3>& uvs,
                        const Footprint& footprint) {
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
                   const Footprint& footprint) {
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

// In [0, 1), from the point's bits.
float coin_at(const TrianglePoint& point) {
    const std::uint64_t place =
        std::uint64_t{std::bit_cast<std::uint32_t>(point.u)} << 32 | std::bit_cast<std::uint32_t>(point.v);
    const std::uint64_t bits =
        map::mixed_bits(place + 0x9E3779B97F4A7C15u * (std::uint64_t{point.triangle} + 1));
    return static_cast<float>(bits >> 40) * 0x1p-24f;
}

glm::vec3 unfiltered_colour(const TrianglePoint& point) {
    const map::Primitive& primitive = point.primitive;
    const map::TextureView& view = point.material().base_texture;
    glm::vec3 colour(point.material().base_colour);
    if (!primitive.colours.empty())
        colour *= glm::vec3(interpolate(primitive.colours, point));
    if (view.present())
        colour *= glm::vec3(
            map::sample(point.map.textures[view.texture], viewed(view, interpolate(primitive.uvs, point))));
    return glm::clamp(colour, 0.0f, 1.0f);
}

// The share of what is there that is clear glass.
float clear_share(const TrianglePoint& point) {
    const map::Material& material = point.material();
    const map::TextureView& view = material.transmission_texture;
    if (!(material.transmission > 0) || !view.present())
        return material.transmission;
    const glm::vec2 uv = viewed(view, interpolate(point.primitive.transmission_uvs, point));
    return material.transmission * map::sample_red(point.map.textures[view.texture], uv);
}

// How much of the point alpha leaves, in [0, 1].
float presence_at(const TrianglePoint& point) {
    const map::Material& material = point.material();
    switch (material.alpha_mode) {
        case map::AlphaMode::opaque:
            return 1;
        case map::AlphaMode::mask:
            return alpha_at(point) >= material.alpha_cutoff ? 1.0f : 0.0f;
        case map::AlphaMode::blend:
            return std::min(alpha_at(point), 1.0f);
    }
    return 1;
}

// As presence_of, by alpha alone.
Presence presence_of_alpha(const map::Map& map, const map::Primitive& primitive, std::uint32_t triangle) {
    const map::Material& material = map.materials[primitive.material];
    if (material.alpha_mode == map::AlphaMode::opaque)
        return Presence::whole;
    const glm::uvec3& t = primitive.triangles[triangle];
    float low = material.base_colour.w;
    float high = low;
    if (!primitive.colours.empty()) {
        const float a = primitive.colours[t.x].w;
        const float b = primitive.colours[t.y].w;
        const float c = primitive.colours[t.z].w;
        low *= std::min({a, b, c});
        high *= std::max({a, b, c});
    }
    if (material.base_texture.present()) {
        const glm::vec2 a = viewed(material.base_texture, primitive.uvs[t.x]);
        const glm::vec2 b = viewed(material.base_texture, primitive.uvs[t.y]);
        const glm::vec2 c = viewed(material.base_texture, primitive.uvs[t.z]);
        const map::AlphaRange range = map::alpha_range(map.textures[material.base_texture.texture],
                                                       glm::min(glm::min(a, b), c),
                                                       glm::max(glm::max(a, b), c));
        low *= static_cast<float>(range.low) / 255.0f;
        high *= static_cast<float>(range.high) / 255.0f;
    }
    constexpr float rounding = 1e-5f;  // of interpolated alphas
    if (material.alpha_mode == map::AlphaMode::mask) {
        if (low - rounding >= material.alpha_cutoff)
            return Presence::whole;
        return high + rounding < material.alpha_cutoff ? Presence::nowhere : Presence::mixed;
    }
    if (low + rounding >= 1)
        return Presence::whole;
    return high <= 0 ? Presence::nowhere : Presence::mixed;
}

}  // namespace

float alpha_at(const TrianglePoint& point) {
    const map::Primitive& primitive = point.primitive;
    const map::Material& material = point.material();
    float alpha = material.base_colour.w;
    if (!primitive.colours.empty())
        alpha *= interpolate(primitive.colours, point).w;
    if (material.base_texture.present())
        alpha *= map::sample_alpha(point.map.textures[material.base_texture.texture],
                                   viewed(material.base_texture, interpolate(primitive.uvs, point)));
    return alpha;
}

bool is_there(const TrianglePoint& point) {
    const map::Material& material = point.material();
    const float present = presence_at(point);
    if (!is_partly_there(material))
        return present > 0;
    if (!(material.transmission > 0))
        return present > coin_at(point);
    const float clear = clear_share(point) * map::brightest(unfiltered_colour(point));
    return present * (1 - clear) > coin_at(point);
}

GlassPassed passed_glass_at(const TrianglePoint& point) {
    if (!(point.material().transmission > 0) || presence_at(point) <= coin_at(point))
        return {};
    const glm::vec3 colour = unfiltered_colour(point);
    const float most = map::brightest(colour);
    return {most > 0 ? colour / most : glm::vec3(1), colour * clear_share(point)};
}

glm::vec3 passed_at(const TrianglePoint& point) {
    const float present = presence_at(point);
    glm::vec3 passed(1 - present);
    if (point.material().transmission > 0)
        passed += unfiltered_colour(point) * (present * clear_share(point));
    return passed;
}

Presence presence_of(const map::Map& map, const map::Primitive& primitive, std::uint32_t triangle) {
    const map::Material& material = map.materials[primitive.material];
    if (!has_holes(material))
        return Presence::whole;
    const Presence of_alpha = presence_of_alpha(map, primitive, triangle);
    return of_alpha == Presence::whole && material.transmission > 0 ? Presence::mixed : of_alpha;
}

float most_scattered(const map::Map& map) {
    std::set<std::pair<std::uint32_t, bool>> seen;  // meshes, as vegetation or not
    std::map<std::uint32_t, glm::vec3> of_textures;
    float most = least_scattered;
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

glm::vec3 emission_at(const TrianglePoint& point, const Footprint& footprint) {
    const map::Material& material = point.material();
    if (!material.emission_texture.present())
        return material.emission;
    return material.emission *
           filtered(point, material.emission_texture, point.primitive.emission_uvs, footprint);
}

Surface surface_at(const TrianglePoint& point, map::Role role, bool front, const Footprint& footprint) {
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
