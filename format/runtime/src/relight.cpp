#include <drtv/relight.h>

#include <algorithm>

namespace drtv {
namespace {

float dot4(const Float4& a, const Float4& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}
float dot3(const Float3& a, const Float3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

DistantLight constant_sky(const Float3& radiance) {
    DistantLight light{};
    for (std::size_t c = 0; c < channel_count; ++c)
        light[c] = {radiance[c] / sh_y0, 0, 0, 0};
    return light;
}

DistantLight directional_sun(const Float3& irradiance, const Float3& to_sun) {
    const Float4 y = evaluate_sh(to_sun);
    DistantLight light{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t i = 0; i < sh_count; ++i)
            light[c][i] = irradiance[c] * y[i];
    }
    return light;
}

BasisColours relight(const Probe& probe, const DistantLight& sky, const DistantLight& sun) {
    return relight(probe.transfer, probe.sky_visibility, sky, sun);
}

BasisColours relight(const TransferCodes& transfer_codes,
                     const VisibilityCodes& sky_visibility,
                     const DistantLight& sky,
                     const DistantLight& sun) {
    BasisColours colours{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        const Float4 basis_sh = evaluate_sh(transfer_basis[b]);
        const float visibility = decode_fixed(sky_visibility[b], sky_visibility_scale);
        for (std::size_t c = 0; c < channel_count; ++c) {
            Float4 transfer;
            for (std::size_t i = 0; i < sh_count; ++i)
                transfer[i] = decode_fixed(transfer_codes[c][b][i], transfer_scale);
            colours[b][c] =
                dot4(sky[c], transfer) + dot4(sun[c], transfer) + dot4(basis_sh, sky[c]) * visibility;
        }
    }
    return colours;
}

void add_static_irradiance(BasisColours& colours, const StaticIrradiance& light, const Float3& tint) {
    const float scale = scale_of_exponent(light.exponent);
    for (std::size_t b = 0; b < basis_count; ++b) {
        for (std::size_t c = 0; c < channel_count; ++c)
            colours[b][c] += tint[c] * decode_fixed(light.codes[c][b], scale);
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

Float3 shade_ambient(const BasisColours& colours, const Float3& normal) {
    Float3 ambient{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        const float cosine = dot3(normal, transfer_basis[b]);
        // The downward weight wraps, for a more pronounced bounce from the ground (s43).
        const bool down = b == basis_count - 1;
        const float weight = down ? cosine * 0.5f + 0.5f : cosine * std::clamp(cosine, 0.0f, 1.0f);
        for (std::size_t c = 0; c < channel_count; ++c)
            ambient[c] += weight * colours[b][c];
    }
    return ambient;
}

}  // namespace drtv
