#include "sky_direct.h"

#include <drtv/relight.h>

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

}  // namespace

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

BasisColours open_sky(const SceneLight& light) {
    const auto direct = sky_direct(light);
    BasisColours colours{};
    for (std::size_t b = 0; b + 1 < basis_count; ++b)
        colours[b] = {direct[0][b], direct[1][b], direct[2][b]};
    return colours;
}

}  // namespace drtv
