// Sample points and the directions made of them, without the C library's trigonometry, whose last bits differ
// between machines.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv::bake {

// Two dimensions for the first direction, two for each bounce, and what is left for draws of lights.
inline constexpr std::uint32_t max_sample_dimensions = 18;

// Points of one Sobol sequence (Sobol 1967; direction numbers of Joe and Kuo 2008), each dimension
// Owen-scrambled (Owen 1995): all dimensions of a path are stratified jointly. Made once for a count of
// paths, shared by all probes.
class SampleTable {
  public:
    // REQUIRES: dimensions <= max_sample_dimensions.
    SampleTable(std::uint32_t count, std::uint32_t dimensions);
    // Other points, point after point: so that samplers can be compared. REQUIRES: words.size() is a multiple
    // of dimensions.
    SampleTable(std::vector<std::uint32_t> words, std::uint32_t dimensions);

    [[nodiscard]] std::uint32_t count() const { return count_; }
    [[nodiscard]] std::span<const std::uint32_t> point(std::uint32_t n) const {
        return {&words_[std::size_t{n} * dimensions_], dimensions_};
    }

    // All numbers of points, so that those whose first two dimensions lie side by side follow each other:
    // rays in this order meet the same parts of a BVH. Within 256, 512, 1024, ... points each; so the first
    // of these are whole. Of each such part a run of a power of two shares a square, and a digital shift
    // moves squares as wholes.
    [[nodiscard]] std::span<const std::uint32_t> side_by_side() const { return order_; }
    static constexpr std::uint32_t first_part = 256;

  private:
    [[nodiscard]] std::uint64_t place_of(std::uint32_t n) const;
    void put_side_by_side();

    std::uint32_t count_;
    std::uint32_t dimensions_;
    std::vector<std::uint32_t> words_;  // fixed point, 32 bits after the point
    std::vector<std::uint32_t> order_;
};

// A probe's own digital shift of the table: words to be XORed, a function of its quantised position alone.
[[nodiscard]] std::array<std::uint32_t, max_sample_dimensions> digital_shift(
    const glm::ivec3& position_units);

// A random word of its three arguments.
[[nodiscard]] std::uint32_t hashed(std::uint32_t key, std::uint32_t n, std::uint32_t dimension);

// In [0, 1).
[[nodiscard]] inline float unit_float(std::uint32_t word) {
    return static_cast<float>(word >> 8) * 0x1p-24f;
}

// In [0, 1]: rounded to the nearest, so that 1 itself comes up once in 2^25 words.
[[nodiscard]] inline float rounded_unit_float(std::uint32_t word) {
    return static_cast<float>(word) * 0x1p-32f;
}

// Two numbers of a point from a dimension on, shifted.
[[nodiscard]] inline glm::vec2 shifted(std::span<const std::uint32_t> point,
                                       const std::array<std::uint32_t, max_sample_dimensions>& shift,
                                       std::size_t dimension) {
    return {unit_float(point[dimension] ^ shift[dimension]),
            unit_float(point[dimension + 1] ^ shift[dimension + 1])};
}

// Uniform on the sphere; z falls with u.x.
[[nodiscard]] glm::vec3 uniform_sphere(glm::vec2 u);

// Density proportional to the cosine to the unit normal.
[[nodiscard]] glm::vec3 cosine_hemisphere(glm::vec2 u, const glm::vec3& normal);

}  // namespace drtv::bake
