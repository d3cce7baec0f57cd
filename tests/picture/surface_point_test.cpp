// Light that comes straight: by hand.
#include "bakerd/picture/surface_point.h"

#include "bakerd/picture/painter.h"
#include "bakerd/trace/device.h"
#include "tests/ambient/scenes.h"
#include "tests/bake/worlds.h"
#include "tests/picture/yard.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <numbers>

namespace drtv::test {
namespace {

using picture::Camera;
using picture::Incidence;
using picture::SurfacePoint;

constexpr float pi = std::numbers::pi_v<float>;
constexpr glm::vec3 albedo(0.5f, 0.25f, 0.125f);

// Level ground; beside the origin a roof 3 m over it.
std::unique_ptr<const picture::Scenery> ground_and_roof() {
    SceneSource scene;
    scene.add_box({-40, -40, -1}, {40, 40, 0}, albedo);
    scene.add_box({10, -5, 3}, {20, 5, 3.2f}, albedo);
    return scenery_of(scene.b);
}

SurfacePoint below(const picture::Scenery& scenery, const glm::vec3& at) {
    const Camera camera = Camera::at(at + glm::vec3(0, 0, 1), at, 60, {});
    const auto point = surface_on(scenery.scene(), camera, camera.ray({480, 270}));
    EXPECT_TRUE(point);
    return *point;
}

void expect_near(const glm::vec3& found, const glm::vec3& right) {
    EXPECT_LT(glm::distance(found, right), 1e-4f * (1 + glm::length(right)))
        << found.x << ' ' << found.y << ' ' << found.z;
}

TEST(SurfacePoint, SunLightsByItsHeightAndNotBelowARoof) {
    const trace::FloatMode float_mode;
    const auto scenery = ground_and_roof();
    const glm::vec3 sun(10, 8, 6);
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
        const glm::vec3 to_sun(0, std::sqrt(1 - cosine * cosine), cosine);
        const Incidence light{to_sun, sun, std::nullopt};
        expect_near(scattered(scenery->scene(), below(*scenery, {0, 0, 0}), light),
                    albedo * sun * (cosine / pi));
    }
    const Incidence high{{0, 0, 1}, sun, std::nullopt};
    EXPECT_EQ(scattered(scenery->scene(), below(*scenery, {15, 0, 0}), high), glm::vec3(0));
    // Its own underside turns away from the sun.
    const Camera up = Camera::at({15, 0, 1}, {15, 0, 2}, 60, {});
    const auto ceiling = surface_on(scenery->scene(), up, up.ray({480, 270}));
    ASSERT_TRUE(ceiling);
    EXPECT_EQ(scattered(scenery->scene(), *ceiling, high), glm::vec3(0));
}

TEST(SurfacePoint, LampLightsByTheInverseSquareAndHasShadows) {
    const trace::FloatMode float_mode;
    const auto scenery = ground_and_roof();
    constexpr Float3 intensity = {90, 45, 9};
    const SurfacePoint point = below(*scenery, {0, 0, 0});
    // 5 m away, at a cosine of 4/5.
    expect_near(scattered(scenery->scene(), point, picture::incidence({{3, 0, 4}, intensity}, point.at)),
                albedo * picture::as_vec(intensity) * (0.8f / 25 / pi));
    const SurfacePoint hidden = below(*scenery, {15, 0, 0});
    EXPECT_EQ(scattered(scenery->scene(), hidden, picture::incidence({{15, 0, 9}, intensity}, hidden.at)),
              glm::vec3(0));
    // A lamp in the place itself is none.
    EXPECT_EQ(picture::incidence({picture::as_place(point.at), intensity}, point.at).irradiance,
              glm::vec3(0));
}

TEST(SurfacePoint, LeavesLetLightThrough) {
    const trace::FloatMode float_mode;
    GltfBuilder b;
    const int leaf = b.add_material({.colour = {0.2f, 0.4f, 0.1f, 1}, .double_sided = true});
    Shape square;
    square.positions = {{-5, -5, 2}, {5, -5, 2}, {5, 5, 2}, {-5, 5, 2}};
    square.indices = {0, 1, 2, 0, 2, 3};
    b.add_node({.mesh = b.add_mesh(in_gltf(square), leaf), .role = "vegetation"});
    const auto scenery = scenery_of(b);
    // Not on the edge between its triangles.
    const Camera up = Camera::at({2, 1, 0}, {2, 1, 1}, 60, {});
    const auto point = surface_on(scenery->scene(), up, up.ray({480, 270}));
    ASSERT_TRUE(point);
    EXPECT_GT(point->surface.transmitted.y, 0.1f);
    const Incidence high{{0, 0, 1}, glm::vec3(pi), std::nullopt};
    expect_near(scattered(scenery->scene(), *point, high), point->surface.transmitted);
}

TEST(Painter, SkyBehindGlassHasItsColour) {
    const trace::FloatMode float_mode;
    GltfBuilder b;
    const int glass = b.add_material({.colour = {0.9f, 0.2f, 0.1f, 1}, .double_sided = true});
    b.json["materials"][static_cast<std::size_t>(glass)]["extensions"] = {
        {"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
    Shape pane;
    pane.positions = {{-5, 4, -5}, {5, 4, -5}, {5, 4, 5}, {-5, 4, 5}};
    pane.indices = {0, 1, 2, 0, 2, 3};
    b.add_node({.mesh = b.add_mesh(in_gltf(pane), glass)});
    const auto scenery = scenery_of(b);
    kit::RequestedLight light;
    light.light.sky = constant_sky({10, 10, 10});
    const picture::Moment moment(baked_yard().set(), light, {}, {});
    const Camera camera = Camera::at({0, 0, 0}, {0, 1, 0.2f}, 40, {});
    const picture::Painter painter(*scenery, moment, camera, picture::Show::all);
    // By chance a ray meets the pane itself, which is dark here.
    glm::vec3 brightest(0);
    for (int n = 0; n < 200; ++n)
        brightest = glm::max(
            brightest, painter.colour({37.0f + static_cast<float>(n) * 4, 211.0f + static_cast<float>(n)}));
    EXPECT_LT(brightest.y, 0.5f * brightest.x);
    EXPECT_LT(brightest.z, brightest.y);
    EXPECT_GT(brightest.x, 5);
}

TEST(DirectLight, GlowingSurfacesShowWhatTheirGroupHas) {
    const trace::FloatMode float_mode;
    const picture::Scenery& scenery = yard_scenery();
    const auto light = morning();
    light->light.sun = {};
    light->lamps.clear();
    const Camera camera = Camera::at({70.5f, 15, 0.6f}, {70.5f, 20, 0.6f}, 60, {});
    const auto glowing = surface_on(scenery.scene(), camera, camera.ray({480, 270}));
    ASSERT_TRUE(glowing);
    for (const float factor : {1.0f, 0.25f}) {
        light->light.other_groups = {factor, factor, factor};
        const picture::Moment moment(baked_yard().set(), *light, {}, {});
        expect_near(direct_light(scenery, moment, *glowing),
                    glm::vec3(1, 0.5f, 0.2f) * (3000 / bake::lumens_per_watt * factor));
    }
}

}  // namespace
}  // namespace drtv::test
