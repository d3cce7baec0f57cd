// Whether a point of a surface is there: alpha, clear glass, and chance.
#include "bakerd/map/colour.h"
#include "bakerd/map/mixed_bits.h"
#include "bakerd/map/texture.h"
#include "bakerd/trace/surface.h"
#include "bakerd/trace/surface_point.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>

namespace drtv::trace {
namespace {

// In [0, 1), from the point's bits.
float coin_at(const TrianglePoint& point) {
    const std::uint64_t place =
        std::uint64_t{std::bit_cast<std::uint32_t>(point.u)} << 32 | std::bit_cast<std::uint32_t>(point.v);
    const std::uint64_t bits =
        map::mixed_bits(place + 0x9E3779B97F4A7C15u * (std::uint64_t{point.triangle} + 1));
    return static_cast<float>(bits >> 40) * 0x1p-24f;
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

float clear_share(const TrianglePoint& point) {
    const map::Material& material = point.material();
    const map::TextureView& view = material.transmission_texture;
    if (!(material.transmission > 0) || !view.present())
        return material.transmission;
    const glm::vec2 uv = viewed(view, interpolate(point.primitive.transmission_uvs, point));
    return material.transmission * map::sample_red(point.map.textures[view.texture], uv);
}

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

}  // namespace drtv::trace
