#include "bakerd/picture/view_rule.h"

#include "bakerd/picture/camera.h"
#include "bakerd/trace/device.h"
#include "tests/picture/yard.h"
#include "tests/runtime/sets.h"

#include <gtest/gtest.h>

#include <set>

namespace drtv::test {
namespace {

TEST(ViewByRule, KeepsItsRule) {
    const trace::FloatMode float_mode;
    const picture::Scenery& scenery = yard_scenery();
    const auto view = picture::view_by_rule(scenery.scene(), baked_yard().set());
    ASSERT_TRUE(view);
    const auto ground = scenery.scene().closest(trace::Ray{view->eye, {0, 0, -1}, 10});
    ASSERT_TRUE(ground);
    EXPECT_NEAR(ground->distance_m, 1.7f, 0.1f);
    const picture::Size size = {120, 68};
    const auto camera = picture::Camera::at(view->eye, view->look, 60, size);
    std::set<std::uint32_t> objects;
    std::size_t sky = 0;
    float nearest = 1e9f;
    for (std::size_t y = 0; y < size.height; ++y) {
        for (std::size_t x = 0; x < size.width; ++x) {
            const auto hit = scenery.scene().closest(camera.ray(glm::vec2(x, y) + 0.5f));
            if (!hit) {
                ++sky;
                continue;
            }
            objects.insert(hit->instance);
            nearest = std::min(nearest, hit->distance_m);
        }
    }
    EXPECT_GE(nearest, 1.95f);
    EXPECT_LT(static_cast<double>(sky), 0.62 * static_cast<double>(size.width * size.height));
    EXPECT_GE(objects.size(), 3u);
}

TEST(ViewByRule, IsTheSameAgain) {
    const auto first = picture::view_by_rule(yard_scenery().scene(), baked_yard().set());
    const auto second = picture::view_by_rule(yard_scenery().scene(), baked_yard().set());
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->eye, second->eye);
    EXPECT_EQ(first->look, second->look);
}

TEST(ViewByRule, WithoutProbesThereIsNone) {
    OwnedSet none;
    EXPECT_FALSE(picture::view_by_rule(yard_scenery().scene(), *none));
}

}  // namespace
}  // namespace drtv::test
