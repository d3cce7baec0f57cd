#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <thread>

namespace drtv::test {
namespace {

using placement::ClosedVolume;

const std::vector<glm::dvec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {7, 7, 7}};

void expect_refusal(const std::vector<glm::dvec3>& positions, const std::vector<glm::uvec3>& triangles,
                    const std::string& reason) {
    const auto volume = ClosedVolume::make(positions, triangles);
    ASSERT_FALSE(volume.has_value());
    EXPECT_NE(volume.error().find(reason), std::string::npos) << volume.error();
}

TEST(ClosedVolume, OpenMeshIsASentenceWithItsName) {
    expect_refusal(corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}, "is open");
}

TEST(ClosedVolume, NoTrianglesIsASentence) {
    expect_refusal({}, {}, "no triangles");
    expect_refusal(corners, {{0, 0, 1}}, "no triangles");
}

TEST(ClosedVolume, EdgeOfThreeTrianglesIsASentence) {
    expect_refusal(corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 1, 4}}, "edge");
}

TEST(ClosedVolume, WindingAndSplitVerticesDoNotMatter) {
    for (unsigned flips = 0; flips < 16; ++flips) {
        std::vector<glm::dvec3> positions;
        std::vector<glm::uvec3> triangles;
        const glm::uvec3 faces[] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        for (unsigned n = 0; n < 4; ++n) {
            const auto first = static_cast<unsigned>(positions.size());
            for (int k = 0; k < 3; ++k)
                positions.push_back(corners[faces[n][k]]);
            if ((flips >> n & 1) != 0)
                triangles.emplace_back(first, first + 2, first + 1);
            else
                triangles.emplace_back(first, first + 1, first + 2);
        }
        const auto volume = ClosedVolume::make(positions, triangles);
        ASSERT_TRUE(volume.has_value()) << volume.error();
        EXPECT_TRUE(volume->contains({0.2, 0.2, 0.2}));
        EXPECT_TRUE(volume->contains({0, 0, 0})) << "the boundary counts";
        EXPECT_FALSE(volume->contains({0.4, 0.4, 0.4}));
        EXPECT_FALSE(volume->contains({-1e-9, 0.2, 0.2}));
    }
}

TEST(ClosedVolume, TwoPartsAreOneVolume) {
    std::vector<glm::dvec3> positions = {corners.begin(), corners.begin() + 4};
    std::vector<glm::uvec3> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (int n = 0; n < 4; ++n)
        positions.push_back(positions[static_cast<std::size_t>(n)] + glm::dvec3(5, 0, 0));
    for (int n = 0; n < 4; ++n)
        triangles.push_back(triangles[static_cast<std::size_t>(n)] + 4u);
    const ClosedVolume volume = ClosedVolume::make(positions, triangles).value();
    EXPECT_TRUE(volume.contains({0.1, 0.1, 0.1}));
    EXPECT_TRUE(volume.contains({5.1, 0.1, 0.1}));
    EXPECT_FALSE(volume.contains({2, 0.1, 0.1}));
}

// Six times the volume within the triangles: positive where they are counter-clockwise seen from outside.
double six_volumes(const ClosedVolume& volume) {
    const std::vector<glm::dvec3> vertices = volume.vertices();
    double sum = 0;
    for (const glm::uvec3& t : volume.triangles())
        sum += glm::dot(vertices[t.x], glm::cross(vertices[t.y], vertices[t.z]));
    return sum;
}

TEST(ClosedVolume, SurfaceIsMergedAndTurnedOutwards) {
    for (const bool inwards : {false, true}) {
        // Each triangle with vertices of its own.
        std::vector<glm::dvec3> positions;
        std::vector<glm::uvec3> triangles;
        for (const glm::uvec3& t :
             {glm::uvec3(0, 2, 1), glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3), glm::uvec3(2, 0, 3)}) {
            const auto first = static_cast<unsigned>(positions.size());
            for (glm::length_t k = 0; k < 3; ++k)
                positions.push_back(corners[t[k]]);
            triangles.emplace_back(first, first + (inwards ? 2 : 1), first + (inwards ? 1 : 2));
        }
        const ClosedVolume volume = ClosedVolume::make(positions, triangles).value();
        EXPECT_EQ(volume.vertices().size(), 4u);
        EXPECT_EQ(volume.triangles().size(), 4u);
        EXPECT_NEAR(six_volumes(volume), 1, 1e-12);
    }
}

// Twelve triangles of a box, each with vertices of its own.
void add_box(const glm::dvec3& low, const glm::dvec3& high, bool inwards, std::vector<glm::dvec3>& positions,
             std::vector<glm::uvec3>& triangles) {
    const ClosedVolume box = box_volume(low, high);
    for (const glm::uvec3& t : box.triangles()) {
        const auto first = static_cast<unsigned>(positions.size());
        for (glm::length_t k = 0; k < 3; ++k)
            positions.push_back(box.vertices()[t[k]]);
        triangles.emplace_back(first, first + (inwards ? 2 : 1), first + (inwards ? 1 : 2));
    }
}

struct BoxPair {
    const char* name;
    glm::dvec3 low_a, high_a, low_b, high_b;
};

class TwoBoxes : public testing::TestWithParam<BoxPair> {};

// Whatever they are wound like, one by one.
TEST_P(TwoBoxes, AreOneVolumeTogether) {
    const auto& [name, low_a, high_a, low_b, high_b] = GetParam();
    const auto in_box = [](const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high) {
        return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
    };
    for (unsigned turned = 0; turned < 4; ++turned) {
        std::vector<glm::dvec3> positions;
        std::vector<glm::uvec3> triangles;
        add_box(low_a, high_a, (turned & 1) != 0, positions, triangles);
        add_box(low_b, high_b, (turned & 2) != 0, positions, triangles);
        const auto made = ClosedVolume::make(positions, triangles);
        if (!made && turned % 3 != 0)
            continue;  // a shared wall wound two ways has no one inside
        ASSERT_TRUE(made.has_value()) << made.error();
        const ClosedVolume& volume = *made;
        std::mt19937 random(turned);
        int wrong = 0;
        for (int n = 0; n < 3000; ++n) {
            // Half of them on faces, edges and corners.
            glm::dvec3 p(glm::uvec3(random() % 15, random() % 15, random() % 9));
            p -= glm::dvec3(1);
            if (n % 2 != 0)
                p += glm::dvec3(glm::uvec3(random() % 997, random() % 997, random() % 997)) / 1000.0;
            wrong += volume.contains(p) != (in_box(p, low_a, high_a) || in_box(p, low_b, high_b)) ? 1 : 0;
        }
        EXPECT_EQ(wrong, 0) << name << ", wound " << turned;
    }
}

INSTANTIATE_TEST_SUITE_P(
    ClosedVolume, TwoBoxes,
    testing::Values(BoxPair{"overlapping", {0, 0, 0}, {8, 8, 6}, {4, 4, 0}, {12, 12, 6}},
                    BoxPair{"one in the other", {0, 0, 0}, {12, 12, 7}, {3, 3, 2}, {9, 9, 5}},
                    BoxPair{"at an edge", {0, 0, 0}, {6, 6, 6}, {6, 6, 0}, {12, 12, 6}},
                    BoxPair{"at a corner", {0, 0, 0}, {6, 6, 3}, {6, 6, 3}, {12, 12, 6}},
                    BoxPair{"at a wall", {0, 0, 0}, {6, 6, 6}, {6, 0, 0}, {12, 6, 6}},
                    BoxPair{"the same", {0, 0, 0}, {6, 6, 6}, {0, 0, 0}, {6, 6, 6}}),
    [](const auto& pair) {
        std::string name = pair.param.name;
        std::ranges::replace(name, ' ', '_');
        return name;
    });

TEST(ClosedVolume, ThreadsAgreeWithTheBoxFormula) {
    const ClosedVolume volume = box_volume({-3, 2, 1}, {4, 9, 3});
    std::vector<int> wrong(4);
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            std::mt19937 random(t);
            for (int n = 0; n < 2000; ++n) {
                const glm::dvec3 p = glm::dvec3(glm::uvec3(random() % 12, random() % 12, random() % 6)) -
                                     glm::dvec3(4, 1, 1);  // often on faces and edges
                const bool inside = p.x >= -3 && p.x <= 4 && p.y >= 2 && p.y <= 9 && p.z >= 1 && p.z <= 3;
                wrong[t] += volume.contains(p) != inside ? 1 : 0;
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace drtv::test
