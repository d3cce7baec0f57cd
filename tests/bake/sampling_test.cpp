#include "bakerd/bake/sampling.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

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
        for (std::uint32_t n = 0; n < count; ++n) strata.insert(table.point(n)[d] >> 22);
        EXPECT_EQ(strata.size(), count) << "dimension " << d;
    }
}

// The first two dimensions of Sobol's sequence are a (0, 2)-sequence: all elementary rectangles hold one point.
TEST(SampleTable, FirstPairFillsEveryElementaryRectangle) {
    const SampleTable table(count, 2);
    for (std::uint32_t across = 0; across <= 10; ++across) {
        std::set<std::uint64_t> cells;
        for (std::uint32_t n = 0; n < count; ++n) {
            const std::uint64_t x = across == 0 ? 0 : table.point(n)[0] >> (32 - across), y = across == 10 ? 0 : table.point(n)[1] >> (22 + across);
            cells.insert(x << 32 | y);
        }
        EXPECT_EQ(cells.size(), count) << across;
    }
}

TEST(SampleTable, DigitalShiftKeepsStrataAndDependsOnThePosition) {
    const SampleTable table(count, 4);
    const auto shift = digital_shift({1, 2, 3});
    std::set<std::uint32_t> strata;
    for (std::uint32_t n = 0; n < count; ++n) strata.insert((table.point(n)[3] ^ shift[3]) >> 22);
    EXPECT_EQ(strata.size(), count);
    for (const glm::ivec3& other : {glm::ivec3(2, 2, 3), glm::ivec3(1, 3, 3), glm::ivec3(1, 2, 4), glm::ivec3(-1, 2, 3), glm::ivec3(2, 1, 3)}) EXPECT_NE(digital_shift(other), shift);
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
    for (const glm::vec3& n : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 0.5f)), glm::normalize(glm::vec3(-1e-4f, 0, -1))}) {
        double cosine = 0;
        for (std::uint32_t s = 0; s < table.count(); ++s) {
            const glm::vec3 w = cosine_hemisphere({unit_float(table.point(s)[0]), unit_float(table.point(s)[1])}, n);
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

}  // namespace
}  // namespace drtv::bake
