// What a map is understood to hold, and doubts about its units and its sides.
#include "bakerd/map/survey.h"
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

namespace drtv::test {
namespace {

using map::Survey;

Survey survey_of(const GltfBuilder& b) {
    return map::survey_of(expect_accepted(b.import()));
}

// A square of the ground, seen from above or, turned, from below.
Shape square(float side_m, bool face_up = true) {
    const float h = side_m / 2;
    return face_up ? quad({-h, 0, h}, {h, 0, h}, {h, 0, -h}, {-h, 0, -h})
                   : quad({-h, 0, -h}, {h, 0, -h}, {h, 0, h}, {-h, 0, h});
}

TEST(Survey, CountsWhatTheMapHolds) {
    GltfBuilder b;
    b.place(square(64));
    const int crate = b.add_mesh(box({0, 0, 0}, {2, 2, 2}));
    b.add_instances(crate, {{1, 0, 0}, {5, 0, 0}, {9, 0, 0}});
    b.add_node({.mesh = crate, .role = "vegetation"});
    b.add_node({.mesh = crate, .role = "ignore"});
    b.add_node({.mesh = crate, .role = "no_probes"});
    b.add_node({.mesh = crate, .role = "interior"});
    b.add_node({.mesh = crate, .spacing = 2});
    b.add_node({.translation = glm::dvec3(0, 1, 0), .role = "probe"});
    b.add_node({.light = b.add_light({{"type", "point"}})});
    b.add_node({.light = b.add_light({{"type", "spot"}, {"spot", Json::object()}})});
    b.add_node({.light = b.add_light({{"type", "directional"}})});
    const int lit = b.add_material({});
    b.json["materials"][static_cast<std::size_t>(lit)]["emissiveFactor"] = {1, 1, 1};
    b.place(box({20, 0, 0}, {21, 5, 1}), "", lit);
    const Survey survey = survey_of(b);
    EXPECT_EQ(survey.static_objects, 5);
    EXPECT_EQ(survey.vegetation_objects, 1);
    EXPECT_EQ(survey.ignored_nodes, 1);
    EXPECT_EQ(survey.triangles, 2 + 5 * 12);
    EXPECT_EQ(survey.lamps, 2);
    EXPECT_EQ(survey.suns, 1);
    EXPECT_EQ(survey.glowing_objects, 1);
    EXPECT_EQ(survey.probes, 1);
    EXPECT_EQ(survey.interiors, 1);
    EXPECT_EQ(survey.probe_free_volumes, 1);
    EXPECT_EQ(survey.spacing_volumes, 1);
    expect_near(survey.low, {-32, -32, 0});
    expect_near(survey.high, {32, 32, 5});
    // Three crates and the lit box, from above and from below; the ground.
    EXPECT_NEAR(survey.up_m2, 64 * 64 + 3 * 4 + 1, 1e-3);
    EXPECT_NEAR(survey.down_m2, 3 * 4 + 1, 1e-3);
}

// Versions of one map share objects, and so a part of their likeness.
TEST(Survey, LikenessIsOfTheSmallestDigests) {
    const auto with_crates = [](int count, float shift_m) {
        GltfBuilder b;
        const int crate = b.add_mesh(box({0, 0, 0}, {1, 1, 1}));
        for (int n = 0; n < count; ++n)
            b.add_node(
                {.mesh = crate, .translation = glm::dvec3(3.0f * static_cast<float>(n) + shift_m, 0, 0)});
        return survey_of(b).likeness;
    };
    EXPECT_EQ(with_crates(2, 0).size(), 32u);
    EXPECT_EQ(with_crates(100, 0).size(), 32u * 16u);
    EXPECT_NE(with_crates(2, 0).find(with_crates(1, 0)), std::string::npos);
    EXPECT_EQ(with_crates(2, 0).find(with_crates(1, 1)), std::string::npos);
    EXPECT_EQ(Survey().likeness, "");
}

TEST(Survey, DoubleSidedFacesBothWaysAndMirrorsTurnNothing) {
    GltfBuilder b;
    b.place(square(10), "", b.add_material({.double_sided = true}));
    b.add_node({.mesh = b.add_mesh(square(2)), .scale = glm::dvec3(-1, 1, 1)});
    const Survey survey = survey_of(b);
    EXPECT_NEAR(survey.up_m2, 104, 1e-4);
    EXPECT_NEAR(survey.down_m2, 100, 1e-4);
}

TEST(Survey, GroundThatFacesDownIsRefusedWithTheCause) {
    GltfBuilder b;
    b.place(square(64, false));
    expect_refused(map::check_survey(survey_of(b)), {"faces up", "on its side, or inside out?"});
    GltfBuilder with_probe = b;
    with_probe.add_node({.role = "probe"});
    EXPECT_TRUE(map::check_survey(survey_of(with_probe)));
    GltfBuilder with_tree = b;
    with_tree.place(box({0, 0, 0}, {1, 1, 1}), "vegetation");
    EXPECT_TRUE(map::check_survey(survey_of(with_tree)));
    GltfBuilder double_sided;
    double_sided.place(square(64, false), "", double_sided.add_material({.double_sided = true}));
    EXPECT_TRUE(map::check_survey(survey_of(double_sided)));
    EXPECT_TRUE(map::check_survey(Survey()));
}

TEST(Survey, DoubtsAboutUnitsAndSides) {
    const auto doubts = [](const Shape& shape) {
        GltfBuilder b;
        b.place(shape);
        return map::doubts_about(survey_of(b));
    };
    const auto told = [](const std::vector<std::string>& sentences, const std::string& part) {
        ASSERT_EQ(sentences.size(), 1u);
        EXPECT_NE(sentences[0].find(part), std::string::npos) << sentences[0];
    };
    EXPECT_TRUE(doubts(square(64)).empty());
    EXPECT_TRUE(doubts(square(8000)).empty());
    told(doubts(square(1.2f)), "only 1.2 m across");
    told(doubts(square(12'000)), "12.0 km across");
    // A wall of a landscape.
    told(doubts(quad({-500, 0, 0}, {500, 0, 0}, {500, 2000, -100}, {-500, 2000, -100})), "2000 m tall");
    // A square map on its side, from which things stick out; and a tower that stands.
    GltfBuilder sideways;
    sideways.place(quad({0, 0, 0}, {150, 0, 0}, {150, 150, 0}, {0, 150, 0}));
    sideways.place(box({50, 50, 0}, {60, 60, 10}));
    told(map::doubts_about(survey_of(sideways)), "150 m tall");
    GltfBuilder small;
    small.place(quad({0, 0, 0}, {90, 0, 0}, {90, 90, 0}, {0, 90, 0}));
    small.place(box({50, 50, 0}, {60, 60, 9}));
    told(map::doubts_about(survey_of(small)), "90 m tall");
    GltfBuilder tower;
    tower.place(square(60));
    tower.place(box({0, 0, 0}, {60, 300, 60}));
    tower.place(box({-200, 0, -200}, {200, 0.1f, 200}));
    EXPECT_TRUE(map::doubts_about(survey_of(tower)).empty());
    GltfBuilder turned;
    turned.place(square(64, false));
    turned.place(box({0, 0, 0}, {3, 3, 3}));
    told(map::doubts_about(survey_of(turned)), "face down");
    EXPECT_TRUE(map::doubts_about(Survey()).empty());
}

}  // namespace
}  // namespace drtv::test
