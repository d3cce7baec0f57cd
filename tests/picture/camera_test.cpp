#include "bakerd/picture/camera.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <random>

namespace drtv::test {
namespace {

using picture::Camera;
using picture::Size;

constexpr Size size = {200, 100};
constexpr glm::vec2 middle(100, 50);

float degrees_between(const glm::vec3& a, const glm::vec3& b) {
    return std::acos(std::min(glm::dot(a, b), 1.0f)) * 180 / std::numbers::pi_v<float>;
}

TEST(Camera, LooksWhereItIsTold) {
    const Camera camera = Camera::at({1, 2, 3}, {1, 12, 3}, 90, size);
    EXPECT_EQ(camera.ray(middle).origin, glm::vec3(1, 2, 3));
    EXPECT_LT(degrees_between(camera.ray(middle).direction, {0, 1, 0}), 0.05f);
    // 45 degrees to each side, east on the right; half as much of the tangent up.
    EXPECT_LT(degrees_between(camera.ray({200, 50}).direction, glm::normalize(glm::vec3(1, 1, 0))), 0.05f);
    EXPECT_LT(degrees_between(camera.ray({0, 50}).direction, glm::normalize(glm::vec3(-1, 1, 0))), 0.05f);
    EXPECT_LT(degrees_between(camera.ray({100, 0}).direction, glm::normalize(glm::vec3(0, 1, 0.5f))), 0.05f);
}

TEST(Camera, StraightUpAndDownItHasEastOnTheRight) {
    for (const float z : {-1.0f, 1.0f}) {
        const Camera camera = Camera::at(glm::vec3(0), {0, 0, z}, 60, size);
        EXPECT_GT(camera.ray({150, 50}).direction.x, 0.1f);
        EXPECT_NEAR(camera.ray({150, 50}).direction.y, 0, 1e-6f);
    }
}

TEST(Camera, ShowsAPlaceWhereItsRayGoes) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share(0, 1);
    const Camera cameras[] = {Camera::at({5, -7, 30}, {60, 20, 10}, 75, size),
                              Camera::above({{-50, 20}, {70, 80}}, 100, size)};
    for (const Camera& camera : cameras) {
        for (int n = 0; n < 200; ++n) {
            const glm::vec2 pixel(200 * share(random), 100 * share(random));
            const auto ray = camera.ray(pixel);
            const float distance_m = 1 + 90 * share(random);
            const auto shown = camera.show(ray.origin + ray.direction * distance_m);
            ASSERT_TRUE(shown);
            EXPECT_LT(glm::distance(shown->pixel, pixel), 2e-3f);
            EXPECT_NEAR(shown->distance_m, distance_m, 1e-3f);
        }
    }
    EXPECT_FALSE(cameras[0].show({-60, -60, 60}));
}

TEST(Camera, FromAboveAPixelIsAPartOfTheWorld) {
    const Camera camera = Camera::above({{-100, 0}, {100, 100}}, 50, size);
    EXPECT_EQ(camera.ray({0, 0}).origin, glm::vec3(-100, 100, 50));
    EXPECT_EQ(camera.ray({200, 100}).origin, glm::vec3(100, 0, 50));
    EXPECT_EQ(camera.ray(middle).direction, glm::vec3(0, 0, -1));
    EXPECT_EQ(camera.pixel_m(7), 1);
}

TEST(Camera, APixelGrowsWithTheDistance) {
    const Camera camera = Camera::at(glm::vec3(0), {0, 1, 0}, 90, size);
    EXPECT_NEAR(camera.pixel_m(10), 10 * 2 / 200.0f, 1e-5f);
}

}  // namespace
}  // namespace drtv::test
