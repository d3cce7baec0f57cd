// The path tracer of pictures beside the slow reference, which shares nothing with it but the map.
#include "bakerd/picture/path_light.h"

#include "bakerd/trace/device.h"
#include "tests/ambient/scenes.h"
#include "tests/ambient/vectors.h"
#include "tests/picture/yard.h"
#include "tests/reference/reference_ambient.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace drtv::test {
namespace {

using picture::Moment;
using picture::PathLight;
using picture::PathParts;

constexpr std::uint32_t paths = 131072;

reference::Moment truth_of(const Moment& moment) {
    reference::Moment truth;
    truth.sky = [&moment](const glm::dvec3& w) { return glm::dvec3(moment.sky(glm::vec3(w), false)); };
    truth.sun_irradiance = as_double(moment.light().sun.irradiance);
    truth.to_sun = glm::normalize(as_double(moment.light().sun.direction));
    for (const PointLight& lamp : moment.lamps())
        truth.lamps.push_back(
            {{lamp.position[0], lamp.position[1], lamp.position[2]}, as_double(lamp.intensity)});
    return truth;
}

void expect_near(const char* what, const glm::vec3& found, const glm::dvec3& right, double scale) {
    for (glm::length_t c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(found[c]), right[c], 0.03 * right[c] + 0.003 * scale)
            << what << ' ' << c;
}

void expect_near(const PathParts& found, const reference::AmbientLight& right) {
    const glm::dvec3 total = right.total();
    const double scale = (total.x + total.y + total.z) / 3;
    expect_near("sky direct", found.sky_direct, right.sky_direct, scale);
    expect_near("sky bounce", found.sky_bounce, right.sky_bounce, scale);
    expect_near("sun bounce", found.sun_bounce, right.sun_bounce, scale);
    expect_near("static", found.static_light, right.static_light, scale);
    expect_near("local", found.local, right.local, scale);
}

TEST(PathLight, AgreesWithTheSlowReference) {
    const trace::FloatMode float_mode;
    const picture::Scenery& scenery = yard_scenery();
    const reference::Scene slow(scenery.map());
    const auto light = morning();
    const Moment moment(baked_yard().set(), *light, {}, {});
    const PathLight path_light(scenery, moment, {});
    const bake::SampleTable table(paths, path_light.dimensions());
    // Beside the red wall, in the open by the glowing box, in the hut, under the leaves.
    const std::array<glm::vec3, 4> places = {glm::vec3(14, 30, 1), glm::vec3(68, 22, 0.8f),
                                             glm::vec3(46, 11, 1.2f), glm::vec3(22, 12, 1.5f)};
    for (const glm::vec3& place : places) {
        const std::array<glm::dvec3, 2> normals = {glm::dvec3(0, 0, 1),
                                                   glm::normalize(glm::dvec3(-1, 0.5, 0.2))};
        const std::array<reference::Moment, 1> moments = {truth_of(moment)};
        const auto right = reference::ambient(slow, glm::dvec3(place), normals, moments, {.strata = 640});
        for (std::size_t n = 0; n < normals.size(); ++n)
            expect_near(path_light.at_normal(place, glm::vec3(normals[n]), table, {1, 2, 3}), right[0][n]);
    }
}

TEST(PathLight, TheFourDirectionsAreFourNormals) {
    const trace::FloatMode float_mode;
    const auto light = morning();
    const Moment moment(baked_yard().set(), *light, {}, {});
    const PathLight path_light(yard_scenery(), moment, {});
    const bake::SampleTable table(paths / 8, path_light.dimensions());
    const glm::vec3 place(68, 22, 1.5f);
    const picture::PathBasis basis = path_light.at_basis(place, table, {4, 5, 6});
    for (std::size_t b = 0; b < basis_count; ++b) {
        const PathParts at_normal =
            path_light.at_normal(place, picture::as_vec(transfer_basis[b]), table, {7, 8, 9});
        for (const picture::ShowName& shown : picture::show_names()) {
            if (shown.show < picture::Show::ambient || shown.show > picture::Show::local)
                continue;
            const glm::vec3 found = part_of(basis[b], shown.show);
            const glm::vec3 right = part_of(at_normal, shown.show);
            EXPECT_LT(glm::distance(found, right),
                      0.05f * glm::length(right) + 0.003f * glm::length(at_normal.total()))
                << b << ' ' << shown.name;
        }
    }
}

TEST(PathLight, InTheOpenThereIsTheSkyAlone) {
    const trace::FloatMode float_mode;
    SceneSource scene;
    scene.add_box({500, 500, 0}, {501, 501, 1}, glm::vec3(0.5f));
    const auto scenery = scenery_of(scene.b);
    kit::RequestedLight light;
    light.light.sky = constant_sky({1, 2, 3});
    const Moment moment(baked_yard().set(), light, {}, {});
    const PathLight path_light(*scenery, moment, {});
    const bake::SampleTable table(1024, path_light.dimensions());
    const PathParts up = path_light.at_normal(glm::vec3(0), {0, 0, 1}, table, {});
    EXPECT_LT(glm::distance(up.total(), {1, 2, 3}), 1e-4f);
    const PathParts sideways = path_light.at_normal(glm::vec3(0), {1, 0, 0}, table, {});
    EXPECT_LT(glm::distance(sideways.total(), {0.5f, 1, 1.5f}), 0.01f);
    EXPECT_EQ(up.sky_bounce + up.sun_bounce + up.static_light + up.local, glm::vec3(0));
}

}  // namespace
}  // namespace drtv::test
