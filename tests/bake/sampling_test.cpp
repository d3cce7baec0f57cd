#include "bakerd/bake/sampling.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace drtv::bake {
namespace {

constexpr std::uint32_t count = 1024;

// Owen scrambling keeps every elementary interval: 2^k points fall one into each of 2^k equal parts.
TEST(SampleTable, EachDimensionIsStratified) {
    const SampleTable table(count, max_sample_dimensions);
    for (std::uint32_t d = 0; d < max_sample_dimensions; ++d) {
        std::set<std::uint32_t> strata;
        for (std::uint32_t n = 0; n < count; ++n)
            strata.insert(table.point(n)[d] >> 22);
        EXPECT_EQ(strata.size(), count) << "dimension " << d;
    }
}

// The first two dimensions of Sobol's sequence are a (0, 2)-sequence: all elementary rectangles hold one
// point.
TEST(SampleTable, FirstPairFillsEveryElementaryRectangle) {
    const SampleTable table(count, 2);
    for (std::uint32_t across = 0; across <= 10; ++across) {
        std::set<std::uint64_t> cells;
        for (std::uint32_t n = 0; n < count; ++n) {
            const std::uint64_t x = across == 0 ? 0 : table.point(n)[0] >> (32 - across),
                                y = across == 10 ? 0 : table.point(n)[1] >> (22 + across);
            cells.insert(x << 32 | y);
        }
        EXPECT_EQ(cells.size(), count) << across;
    }
}

TEST(SampleTable, DigitalShiftKeepsStrataAndDependsOnThePosition) {
    const SampleTable table(count, 4);
    const auto shift = digital_shift({1, 2, 3});
    std::set<std::uint32_t> strata;
    for (std::uint32_t n = 0; n < count; ++n)
        strata.insert((table.point(n)[3] ^ shift[3]) >> 22);
    EXPECT_EQ(strata.size(), count);
    for (const glm::ivec3& other : {glm::ivec3(2, 2, 3), glm::ivec3(1, 3, 3), glm::ivec3(1, 2, 4),
                                    glm::ivec3(-1, 2, 3), glm::ivec3(2, 1, 3)})
        EXPECT_NE(digital_shift(other), shift);
    EXPECT_EQ(digital_shift({1, 2, 3}), shift);
}

TEST(Directions, SphereIsUnitAndUniform) {
    const SampleTable table(65536, 2);
    glm::dvec3 mean(0);
    glm::dvec3 square(0);
    for (std::uint32_t n = 0; n < table.count(); ++n) {
        const glm::vec3 w = uniform_sphere({unit_float(table.point(n)[0]), unit_float(table.point(n)[1])});
        ASSERT_NEAR(glm::length(w), 1, 1e-6);
        mean += glm::dvec3(w);
        square += glm::dvec3(w * w);
    }
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(mean[axis] / table.count(), 0, 1e-4);
        EXPECT_NEAR(square[axis] / table.count(), 1.0 / 3, 1e-4);
    }
}

TEST(Directions, HemisphereFollowsTheCosineAroundAnyNormal) {
    const SampleTable table(16384, 2);
    for (const glm::vec3& n :
         {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 0.5f)),
          glm::normalize(glm::vec3(-1e-4f, 0, -1))}) {
        double cosine = 0;
        for (std::uint32_t s = 0; s < table.count(); ++s) {
            const glm::vec3 w =
                cosine_hemisphere({unit_float(table.point(s)[0]), unit_float(table.point(s)[1])}, n);
            ASSERT_NEAR(glm::length(w), 1, 2e-6);
            ASSERT_GE(glm::dot(w, n), -1e-6f);
            cosine += static_cast<double>(glm::dot(w, n));
        }
        EXPECT_NEAR(cosine / table.count(), 2.0 / 3, 1e-3);  // mean cosine of a cosine lobe
    }
}

TEST(Directions, AzimuthAgreesWithTheLibraryToSevenDigits) {
    for (int n = 0; n < 4096; ++n) {
        const float u = static_cast<float>(n) / 4096;
        const glm::vec3 w = uniform_sphere({0.5f, u});
        EXPECT_NEAR(w.x, std::cos(2 * M_PI * static_cast<double>(u)), 3e-7);
        EXPECT_NEAR(w.y, std::sin(2 * M_PI * static_cast<double>(u)), 3e-7);
    }
}

// Parts of 256, 512, ... are whole, and in each a run of 16 lies in one square of the first two dimensions,
// shifted or not.
TEST(SampleTable, OrderPutsNeighboursSideBySide) {
    constexpr std::uint32_t total = 2048;
    const SampleTable samples(total, 4);
    const auto order = samples.side_by_side();
    ASSERT_EQ(order.size(), total);
    std::vector<bool> seen(total, false);
    for (std::uint32_t from = 0, to = SampleTable::first_part; from < total; from = to, to *= 2) {
        for (std::uint32_t at = from; at < to; ++at) {
            EXPECT_GE(order[at], from);
            EXPECT_LT(order[at], to);
            EXPECT_FALSE(seen[order[at]]);
            seen[order[at]] = true;
        }
        const std::uint32_t points = to - from;
        std::uint32_t side_bits = 0;  // squares of which each holds 16 points
        while ((16u << 2 * (side_bits + 1)) <= points)
            ++side_bits;
        for (std::uint32_t first = from; first < to; first += points >> (2 * side_bits)) {
            for (const std::uint32_t shift : {0u, 0xA5C3F096u}) {
                for (std::size_t d = 0; d < 2 && side_bits > 0; ++d) {
                    const std::uint32_t square = (samples.point(order[first])[d] ^ shift) >> (32 - side_bits);
                    for (std::uint32_t k = 1; k < points >> (2 * side_bits); ++k)
                        EXPECT_EQ((samples.point(order[first + k])[d] ^ shift) >> (32 - side_bits), square);
                }
            }
        }
    }
}

}  // namespace
}  // namespace drtv::bake
