#include "bakerd/bake/sampling.h"

#include "bakerd/map/cos_sin.h"
#include "bakerd/map/mixed_bits.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace drtv::bake {
namespace {

// Joe and Kuo 2008, new-joe-kuo-6: degree, coefficients and initial direction numbers of dimensions 2 to 18.
struct Polynomial {
    std::uint32_t degree;
    std::uint32_t coefficients;
    std::array<std::uint32_t, 7> m;
};
constexpr std::array<Polynomial, max_sample_dimensions - 1> polynomials = {{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
}};

using Directions = std::array<std::uint32_t, 32>;

Directions direction_numbers(std::uint32_t dimension) {
    Directions v{};
    if (dimension == 0) {
        for (std::uint32_t k = 0; k < 32; ++k)
            v[k] = 1u << (31 - k);
        return v;
    }
    const Polynomial& p = polynomials[dimension - 1];
    for (std::uint32_t k = 0; k < p.degree; ++k)
        v[k] = p.m[k] << (31 - k);
    for (std::uint32_t k = p.degree; k < 32; ++k) {
        v[k] = v[k - p.degree] ^ (v[k - p.degree] >> p.degree);
        for (std::uint32_t q = 1; q < p.degree; ++q) {
            if ((p.coefficients >> (p.degree - 1 - q) & 1u) != 0)
                v[k] ^= v[k - q];
        }
    }
    return v;
}

// Nested uniform scrambling: each bit is flipped by a coin that depends on all bits before it.
std::uint32_t owen_scramble(std::uint32_t word, std::uint32_t dimension) {
    std::uint32_t flips = 0;
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
        const std::uint64_t prefix = bit == 0 ? 0 : word >> (32 - bit);
        const std::uint64_t coin = map::mixed_bits(
            (std::uint64_t{dimension} << 38 | std::uint64_t{bit} << 32 | prefix) + 0x9E3779B97F4A7C15u);
        flips |= static_cast<std::uint32_t>(coin >> 63) << (31 - bit);
    }
    return word ^ flips;
}

// Cosine and sine of 2 pi u, u in [0, 1): Taylor series within an eighth of a turn, error below 2^-23.
glm::vec2 cos_sin_turn(float u) {
    const float quarter = std::floor(u * 4 + 0.5f);
    const float x = (u - quarter * 0.25f) * 6.28318530717958648f;
    const float x2 = x * x;
    const float s =
        x * (1 + x2 * (-1 / 6.0f + x2 * (1 / 120.0f + x2 * (-1 / 5040.0f + x2 * (1 / 362880.0f)))));
    const float c = 1 + x2 * (-0.5f + x2 * (1 / 24.0f + x2 * (-1 / 720.0f + x2 * (1 / 40320.0f))));
    return map::quarters_on(glm::vec2(c, s), static_cast<int>(quarter));
}

}  // namespace

SampleTable::SampleTable(std::uint32_t count, std::uint32_t dimensions)
    : count_(count), dimensions_(dimensions), words_(std::size_t{count} * dimensions) {
    assert(dimensions <= max_sample_dimensions);
    for (std::uint32_t d = 0; d < dimensions; ++d) {
        const Directions v = direction_numbers(d);
        for (std::uint32_t n = 0; n < count; ++n) {
            std::uint32_t word = 0;
            for (std::uint32_t k = 0; k < 32; ++k) {
                if ((n >> k & 1u) != 0)
                    word ^= v[k];
            }
            words_[std::size_t{n} * dimensions + d] = owen_scramble(word, d);
        }
    }
    put_side_by_side();
}

SampleTable::SampleTable(std::vector<std::uint32_t> words, std::uint32_t dimensions)
    : count_(static_cast<std::uint32_t>(words.size() / dimensions)),
      dimensions_(dimensions),
      words_(std::move(words)) {
    put_side_by_side();
}

void SampleTable::put_side_by_side() {
    order_.resize(count_);
    std::iota(order_.begin(), order_.end(), 0u);
    for (std::uint32_t from = 0, to = first_part; from < count_; from = to, to *= 2) {
        std::sort(order_.begin() + from,
                  order_.begin() + std::min(to, count_),
                  [&](std::uint32_t a, std::uint32_t b) { return place_of(a) < place_of(b); });
    }
}

// The place of the first two dimensions along a Z-order curve.
std::uint64_t SampleTable::place_of(std::uint32_t n) const {
    std::uint64_t place = 0;
    for (std::uint32_t bit = 32; bit-- > 0;)
        place = place << 2 | std::uint64_t{point(n)[0] >> bit & 1u} << 1 | (point(n)[1] >> bit & 1u);
    return place;
}

std::array<std::uint32_t, max_sample_dimensions> digital_shift(const glm::ivec3& p) {
    std::uint64_t state = map::mixed_bits(static_cast<std::uint32_t>(p.x) + 0x9E3779B97F4A7C15u);
    state = map::mixed_bits(state ^ static_cast<std::uint32_t>(p.y));
    state = map::mixed_bits(state ^ static_cast<std::uint32_t>(p.z));
    std::array<std::uint32_t, max_sample_dimensions> shift{};
    for (std::uint32_t& word : shift) {
        state += 0x9E3779B97F4A7C15u;
        word = static_cast<std::uint32_t>(map::mixed_bits(state) >> 32);
    }
    return shift;
}

std::uint32_t hashed(std::uint32_t key, std::uint32_t n, std::uint32_t dimension) {
    return static_cast<std::uint32_t>(
        map::mixed_bits(map::mixed_bits((std::uint64_t{key} << 32 | n) + 0x9E3779B97F4A7C15u) ^ dimension) >>
        32);
}

glm::vec3 uniform_sphere(glm::vec2 u) {
    const float z = 1 - 2 * u.x;
    const float r = std::sqrt(std::max(0.0f, 1 - z * z));
    const glm::vec2 turn = cos_sin_turn(u.y);
    return {r * turn.x, r * turn.y, z};
}

glm::vec3 cosine_hemisphere(glm::vec2 u, const glm::vec3& normal) {
    const float r = std::sqrt(u.x);
    const float z = std::sqrt(std::max(0.0f, 1 - u.x));
    const glm::vec2 turn = cos_sin_turn(u.y);
    // An orthonormal basis without branches (Duff et al. 2017).
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1 / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    const glm::vec3 tangent(1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    const glm::vec3 bitangent(b, sign + normal.y * normal.y * a, -normal.y);
    return tangent * (r * turn.x) + bitangent * (r * turn.y) + normal * z;
}

}  // namespace drtv::bake
