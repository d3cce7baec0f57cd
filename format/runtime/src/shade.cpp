// The colours of probes: packed, and as light at a normal.
#include <drtv/relight.h>

#include "half.h"
#include "vector.h"

#include <algorithm>

namespace drtv {

PackedColours packed(const BasisColours& colours) {
    PackedColours result;
    for (std::size_t k = 0; k < channel_count; ++k) {
        for (std::size_t c = 0; c < channel_count; ++c)
            result[k][c] = half_of(colours[k][c]);
        result[k][3] = half_of(colours[3][k]);
    }
    return result;
}

BasisColours unpacked(const PackedColours& colours) {
    BasisColours result;
    for (std::size_t k = 0; k < channel_count; ++k) {
        for (std::size_t c = 0; c < channel_count; ++c)
            result[k][c] = float_of_half(colours[k][c]);
        result[3][k] = float_of_half(colours[k][3]);
    }
    return result;
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
        light[c] = intensity[c] * ((local[0] * y[0] + local[2] * y[2]) + (local[1] * y[1] + local[3] * y[3]));
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
