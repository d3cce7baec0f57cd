#include <drtv/relight.h>

#include "simd.h"
#include "vector.h"

#include <algorithm>

namespace drtv {
namespace {

// (1/pi) times the integral of max(0, w.b) Y_i over the upper hemisphere, in closed form: what a sky of Y_i
// gives to a cosine around b. The downward direction sees none of it.
constexpr std::array<Float4, basis_count> open_sky_shares = {
    {{0.222481148f, -0.160289310f, 0.215533855f, -0.092543076f},
     {0.222481148f, 0.160289310f, 0.215533855f, -0.092543076f},
     {0.222481148f, 0.0f, 0.215533855f, 0.185086153f},
     {0, 0, 0, 0}}};

float dot4(const Float4& a, const Float4& b) {
    return (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3]);
}

// What a visibility of 1 brings, [c][b]. The talk's code takes the sky's radiance in the direction itself.
std::array<Float4, channel_count> sky_direct(const SceneLight& light) {
    std::array<Float4, channel_count> direct{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            const bool literal = light.mode == RelightMode::literal;
            direct[c][b] = dot4(literal ? evaluate_sh(transfer_basis[b]) : open_sky_shares[b], light.sky[c]);
        }
    }
    return direct;
}

DistantLight sky_and_sun(const SceneLight& light) {
    DistantLight sum = sun_as_sh(light.mode, light.sun);
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t i = 0; i < sh_count; ++i)
            sum[c][i] += light.sky[c][i];
    }
    return sum;
}

template <class Numbers>
void scale(Numbers& numbers, float factor) {
    for (Float4& row : numbers) {
        for (float& number : row)
            number *= factor;
    }
}

// The four colours of one channel.
Lanes bounce_and_sky(const std::int16_t* transfer,
                     const Float4& bounce,
                     Lanes visibility,
                     const Float4& direct) {
    Lanes columns[sh_count];
    load_columns(transfer, columns);
    const Lanes even = columns[0] * splat(bounce[0]) + columns[2] * splat(bounce[2]);
    const Lanes odd = columns[1] * splat(bounce[1]) + columns[3] * splat(bounce[3]);
    return (even + odd) + visibility * load(direct.data());
}

BasisColours by_basis(const std::array<Lanes, channel_count>& channels) {
    std::array<Float4, channel_count> rows;
    for (std::size_t c = 0; c < channel_count; ++c)
        store(channels[c], rows[c].data());
    BasisColours colours;
    for (std::size_t b = 0; b < basis_count; ++b)
        colours[b] = {rows[0][b], rows[1][b], rows[2][b]};
    return colours;
}

}  // namespace

ProbeRelighter::ProbeRelighter(const SectorView& sector, const SceneLight& light)
    : sector_(&sector), bounce_(sky_and_sun(light)), sky_direct_(sky_direct(light)) {
    scale(bounce_, transfer_scale / fixed_point_max);
    scale(sky_direct_, sky_visibility_scale / fixed_point_max);
    const auto per_code = [](const Float3& factor) {
        return Float3{factor[0] / fixed_point_max, factor[1] / fixed_point_max, factor[2] / fixed_point_max};
    };
    static_factor_ = per_code(light.static_colour);
    for (std::size_t g = 0; g < sector.light_group_names.size(); ++g) {
        const std::string_view name = light_group_name(sector, g);
        Float3 colour = light.other_groups;
        for (const GroupColour& group : light.groups) {
            if (group.name == name)
                colour = group.colour;
        }
        if (colour != Float3{})
            groups_[group_count_++] = {g, per_code(colour)};
    }
}

BasisColours ProbeRelighter::operator()(std::size_t p) const {
    const TransferCodes& transfer = sector_->transfer[p];
    const Lanes visibility = load_codes(sector_->sky_visibility[p].data());
    std::array<Lanes, channel_count> channels;
    for (std::size_t c = 0; c < channel_count; ++c)
        channels[c] = bounce_and_sky(transfer[c][0].data(), bounce_[c], visibility, sky_direct_[c]);
    const auto add = [&](const LightCodes& codes, std::int8_t exponent, const Float3& factor) {
        const float scale = scale_of_exponent(exponent);
        for (std::size_t c = 0; c < channel_count; ++c)
            channels[c] = channels[c] + load_codes(codes[c].data()) * splat(scale * factor[c]);
    };
    if (!sector_->static_irradiance.empty())
        add(sector_->static_irradiance[p], sector_->static_exponents[p], static_factor_);
    for (std::size_t n = 0; n < group_count_; ++n) {
        const std::size_t at = groups_[n].index * sector_->probe_count + p;
        add(sector_->light_group_irradiance[at], sector_->light_group_exponents[at], groups_[n].factor);
    }
    return by_basis(channels);
}

BasisColours relight(const SectorView& sector, std::size_t p, const SceneLight& light) {
    return ProbeRelighter(sector, light)(p);
}

BasisColours relight(const TransferCodes& transfer,
                     const VisibilityCodes& sky_visibility,
                     const SceneLight& light) {
    SectorView sector;
    sector.probe_count = 1;
    sector.transfer = {&transfer, 1};
    sector.sky_visibility = {&sky_visibility, 1};
    return relight(sector, 0, light);
}

BasisColours clamped(const BasisColours& colours) {
    BasisColours result;
    for (std::size_t b = 0; b < basis_count; ++b) {
        for (std::size_t c = 0; c < channel_count; ++c)
            result[b][c] = colours[b][c] > 0 ? colours[b][c] : 0;
    }
    return result;
}

BasisColours open_sky(const SceneLight& light) {
    const auto direct = sky_direct(light);
    BasisColours colours{};
    for (std::size_t b = 0; b + 1 < basis_count; ++b)
        colours[b] = {direct[0][b], direct[1][b], direct[2][b]};
    return colours;
}

void add_static_irradiance(BasisColours& colours, const StaticIrradiance& light, const Float3& factor) {
    const float scale = scale_of_exponent(light.exponent);
    for (std::size_t b = 0; b < basis_count; ++b) {
        for (std::size_t c = 0; c < channel_count; ++c)
            colours[b][c] += factor[c] * decode_fixed(light.codes[c][b], scale);
    }
}

Float3 shade_local(const LightCodes& pair, float scale, const Float3& intensity, const Float3& normal) {
    const Float4 y = evaluate_sh(normal);
    Float3 light{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        Float4 local;
        for (std::size_t i = 0; i < sh_count; ++i)
            local[i] = decode_fixed(pair[c][i], scale);
        light[c] = intensity[c] * dot4(local, y);
    }
    return light;
}

Float4 basis_weights(RelightMode mode, const Float3& normal) {
    const Float3 n = is_finite(normal) ? normal : Float3{};
    Float4 weights{};
    if (mode == RelightMode::literal) {
        for (std::size_t b = 0; b + 1 < basis_count; ++b) {
            const float cosine = dot(n, transfer_basis[b]);
            weights[b] = cosine * std::clamp(cosine, 0.0f, 1.0f);
        }
        // The downward weight wraps, for a more pronounced bounce from the ground (slide 43).
        weights[3] = dot(n, transfer_basis[3]) * 0.5f + 0.5f;
        return weights;
    }
    // Linear in the normal, 1 at its own direction and 0 at the others: exact for c0 + c.n.
    constexpr float per_height = 0.633974596f;  // 1 / (1 + 1 / sqrt(3))
    const float upper = (1 + n[2]) * per_height;
    for (std::size_t b = 0; b + 1 < basis_count; ++b)
        weights[b] = upper / 3 + (n[0] * transfer_basis[b][0] + n[1] * transfer_basis[b][1]);
    weights[3] = 1 - upper;
    return weights;
}

Float3 shade_ambient(RelightMode mode, const BasisColours& colours, const Float3& normal) {
    const Float4 weights = basis_weights(mode, normal);
    Float3 ambient{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        for (std::size_t c = 0; c < channel_count; ++c)
            ambient[c] += weights[b] * colours[b][c];
    }
    for (float& channel : ambient)
        channel = channel > 0 ? channel : 0;
    return ambient;
}

}  // namespace drtv
