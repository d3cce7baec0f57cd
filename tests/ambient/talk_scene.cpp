#include "tests/ambient/talk_scene.h"

#include <cmath>
#include <numbers>

namespace drtv::test {
namespace {

constexpr glm::vec3 green(0.15f, 0.5f, 0.1f);
constexpr glm::vec3 red(0.8f, 0.1f, 0.05f);
constexpr glm::vec3 blue(0.05f, 0.1f, 0.8f);
constexpr glm::vec3 white(0.7f);

// Rolling by half a metre.
Shape terrain(float low, float high) {
    constexpr int steps = 40;
    Shape shape;
    const auto corner = [&](int x, int y) {
        const float u = low + (high - low) * static_cast<float>(x) / steps;
        const float v = low + (high - low) * static_cast<float>(y) / steps;
        return glm::vec3(u, v, x % 8 == 4 && y % 8 == 4 ? 0.0f : -0.5f);
    };
    for (int y = 0; y < steps; ++y) {
        for (int x = 0; x < steps; ++x) {
            const auto first = static_cast<std::uint32_t>(shape.positions.size());
            shape.positions.insert(shape.positions.end(),
                                   {corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)});
            for (const std::uint32_t n : {0u, 1u, 2u, 0u, 2u, 3u})
                shape.indices.push_back(first + n);
        }
    }
    return shape;
}

Shape sphere(const glm::vec3& middle, float radius_m) {
    constexpr std::uint32_t rings = 8;
    constexpr std::uint32_t around = 16;
    Shape shape;
    for (std::uint32_t r = 0; r <= rings; ++r) {
        const double theta = std::numbers::pi * r / rings;
        for (std::uint32_t s = 0; s < around; ++s) {
            const double phi = 2 * std::numbers::pi * s / around;
            const glm::dvec3 out(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta));
            shape.positions.push_back(middle + radius_m * glm::vec3(out));
        }
    }
    for (std::uint32_t r = 0; r < rings; ++r) {
        for (std::uint32_t s = 0; s < around; ++s) {
            const std::uint32_t a = r * around + s;
            const std::uint32_t b = r * around + (s + 1) % around;
            for (const std::uint32_t n : {a, a + around, b, b, a + around, b + around})
                shape.indices.push_back(n);
        }
    }
    return shape;
}

}  // namespace

SceneSource talk_scene() {
    SceneSource scene;
    scene.add(terrain(-200, 400), green);
    scene.add_box({11, 20, -1}, {12, 44, 7}, red);
    scene.add_box({40, 20, -1}, {41, 44, 7}, blue);
    for (const glm::vec3& middle : {beside_red, beside_blue, glm::vec3(26, 32, 2)})
        scene.add(sphere(middle, sphere_radius_m), white);
    scene.add_box({white_wall_x, 24, -1}, {white_wall_x + 1, 40, 6}, white);
    // The hut: walls of 0.3 m, closed but for a door of 1 x 2 m to the north.
    constexpr float wall_m = 0.3f;
    const glm::vec3 low = hut_low - glm::vec3(wall_m, wall_m, 1);
    const glm::vec3 high = hut_high + wall_m;
    scene.add_box({low.x, low.y, hut_high.z}, high, white);
    scene.add_box(low, {high.x, hut_low.y, hut_high.z}, white);
    scene.add_box({low.x, hut_low.y, low.z}, {hut_low.x, high.y, hut_high.z}, white);
    scene.add_box({hut_high.x, hut_low.y, low.z}, {high.x, high.y, hut_high.z}, white);
    scene.add_box({hut_low.x, hut_high.y, low.z}, {46.5f, high.y, hut_high.z}, white);
    scene.add_box({47.5f, hut_high.y, low.z}, {hut_high.x, high.y, hut_high.z}, white);
    scene.add_interior(hut_low - glm::vec3(0.5f, 0.5f, 1), hut_high + glm::vec3(0.5f),
                       (hut_low + hut_high) * 0.5f - glm::vec3(0, 0, 0.5f));
    // A canopy at 8 m over the sectors from x = 128 on, with a gap of 0.4 m between its leaves of 4 m.
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const glm::vec3 at(128 + 4 * x, 4 * y, 8);
            scene.add_box(at + glm::vec3(0.2f, 0.2f, 0), at + glm::vec3(3.8f, 3.8f, 0.1f), green);
        }
    }
    return scene;
}

BakedMap baked_like_talk_scene(const GltfBuilder& builder) {
    settings::BakeSettings settings;
    settings.rays = 512;
    settings.min_distance_m = 4;
    settings.local_transfer = true;
    return {builder, settings, {{0, 0}, {1, 0}, {2, 0}}};
}

const BakedMap& baked_talk_scene() {
    static const BakedMap map = baked_like_talk_scene(talk_scene().b);
    return map;
}

}  // namespace drtv::test
