// Roles by extras, probes, volumes, punctual lights.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <numbers>

namespace drtv::test {
namespace {

using map::Map;

constexpr float rounding = 1e-6f;  // normalised directions

TEST(Role, StaticIsTheDefault) {
    GltfBuilder b;
    b.place(ground(1));
    EXPECT_EQ(expect_accepted(b.import()).objects.at(0).role, map::Role::fixed);
}

TEST(Role, ChildrenInheritAndMayOverride) {
    GltfBuilder b;
    const int mesh = b.add_mesh(ground(1));
    const int leaf = b.add_node({.mesh = mesh, .name = "leaf"});
    const int trunk = b.add_node({.mesh = mesh, .name = "trunk", .role = "static"});
    const int car = b.add_node({.mesh = mesh, .name = "car", .role = "ignore"});
    const int middle = b.add_node({.children = {leaf, trunk, car}});
    b.add_node({.children = {middle}, .role = "vegetation"});
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.objects.size(), 2u);
    for (const map::Object& object : map.objects)
        EXPECT_EQ(object.role, object.name == "leaf" ? map::Role::vegetation : map::Role::fixed)
            << object.name;
}

TEST(Role, ProbeStandsAtItsOrigin) {
    GltfBuilder b;
    const int probe = b.add_node(
        {.mesh = b.add_mesh(ground(1)), .translation = glm::dvec3(1, 2, 3), .name = "here", .role = "probe"});
    b.add_node({.translation = glm::dvec3(10, 0, 0), .scale = glm::dvec3(2, 2, 2), .children = {probe}});
    const Map map = expect_accepted(b.import());
    EXPECT_TRUE(map.objects.empty());
    ASSERT_EQ(map.probes.size(), 1u);
    EXPECT_EQ(map.probes[0].position, glm::dvec3(12, -6, 4));
    EXPECT_EQ(map.probes[0].name, "here");
}

TEST(Role, MeshesThatBecomeProbesByInheritanceAreTold) {
    GltfBuilder b;
    b.place(ground(1));
    const int mesh = b.add_mesh(ground(1));
    const int one = b.add_node({.mesh = mesh, .name = "one"});
    const int two = b.add_node({.mesh = mesh, .name = "two"});
    b.add_node({.children = {one, two}, .name = "hut", .role = "probe"});
    b.add_node({.mesh = mesh, .name = "marker", .role = "probe"});
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.warnings.size(), 1u);
    EXPECT_NE(map.warnings[0].find("('hut'): 2 meshes below it inherit its bake_role 'probe'"),
              std::string::npos)
        << map.warnings[0];
}

TEST(Role, ASpacingAloneOnWhatGlowsIsTold) {
    GltfBuilder b;
    b.place(ground(1));
    const int material = b.add_material({.name = "ember"});
    b.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    const int mesh = b.add_mesh(box({0, 0, 0}, {1, 1, 1}), material);
    b.add_node({.mesh = mesh, .name = "ember", .spacing = 2});
    b.add_node({.mesh = mesh, .name = "both", .role = "static", .spacing = 2});
    const Map map = expect_accepted(b.import());
    const auto is_told = [](const std::string& warning) {
        return warning.find("bake_spacing without a bake_role") != std::string::npos;
    };
    ASSERT_EQ(std::ranges::count_if(map.warnings, is_told), 1);
    EXPECT_NE(std::ranges::find_if(map.warnings, is_told)->find("('ember')"), std::string::npos);
}

TEST(Role, VolumesAreInWorldSpace) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(triangle({1, 2, 3}, {2, 2, 3}, {1, 3, 3})),
                .translation = glm::dvec3(10, 20, 30),
                .name = "hall",
                .role = "no_probes"});
    const Map map = expect_accepted(b.import());
    EXPECT_TRUE(map.objects.empty());
    ASSERT_EQ(map.volumes.size(), 1u);
    EXPECT_EQ(map.volumes[0].kind, map::VolumeKind::no_probes);
    EXPECT_EQ(map.volumes[0].name, "hall");
    EXPECT_EQ(map.volumes[0].positions,
              (std::vector<glm::dvec3>{{11, -33, 22}, {12, -33, 22}, {11, -33, 23}}));
    EXPECT_EQ(map.volumes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
}

TEST(Role, VolumeOfSeveralPrimitivesIsOneVolume) {
    GltfBuilder b;
    b.place(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), "no_probes");
    b.add_primitive(0, triangle({5, 0, 0}, {6, 0, 0}, {5, 1, 0}), b.add_material({.colour = {1, 0, 0, 1}}));
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.volumes.size(), 1u);
    EXPECT_EQ(map.volumes[0].positions.size(), 6u);
    EXPECT_EQ(map.volumes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(Role, InteriorNamesItsProbeEvenInAnotherFile) {
    GltfBuilder house, probes;
    house.add_node({.mesh = house.add_mesh(box({0, 0, 0}, {1, 1, 1})), .role = "interior", .probe = "lamp"});
    probes.add_node({.translation = glm::dvec3(0.5, 0.5, 0.5), .name = "lamp", .role = "probe"});
    const Files files = {{"house.gltf", bytes_of(house.gltf())}, {"probes.gltf", bytes_of(probes.gltf())}};
    const Map map = expect_accepted(import_files(files, {"house.gltf", "probes.gltf"}));
    EXPECT_EQ(map.volumes.at(0).kind, map::VolumeKind::interior);
    EXPECT_EQ(map.volumes.at(0).probe_name, "lamp");
    expect_refused(import_files(files, {"house.gltf"}), {"house.gltf", "interior", "lamp"});
}

TEST(Role, InteriorNamingTwoProbesIsRefused) {
    GltfBuilder b;
    b.add_node(
        {.mesh = b.add_mesh(box({0, 0, 0}, {1, 1, 1})), .name = "room", .role = "interior", .probe = "lamp"});
    for (int n = 0; n < 2; ++n)
        b.add_node({.name = "lamp", .role = "probe"});
    expect_refused(b.import(), {"map.gltf", "room", "lamp", "2"});
}

TEST(Role, UnknownOneIsRefused) {
    GltfBuilder b;
    b.add_node({.name = "tree", .role = "vegetatoin"});
    expect_refused(b.import(), {"map.gltf", "node 0", "tree", "vegetatoin", "vegetation"});
    b.json["nodes"][0]["extras"]["bake_role"] = 3;
    expect_refused(b.import(), {"map.gltf", "node 0", "bake_role"});
    b.json["nodes"][0]["extras"] = Json::parse(R"({"bake_role": "interior", "bake_probe": 1})");
    expect_refused(b.import(), {"map.gltf", "node 0", "bake_probe"});
}

TEST(Role, OtherExtrasDoNotMatter) {
    for (const char* extras : {"3", "\"text\"", "[1, 2]", "null", R"({"bake": 1, "role": {}})"}) {
        GltfBuilder b;
        b.place(ground(1));
        b.json["nodes"][0]["extras"] = Json::parse(extras);
        EXPECT_EQ(expect_accepted(b.import()).objects.size(), 1u) << extras;
    }
}

TEST(Light, PointIsReadWithItsPlace) {
    GltfBuilder b;
    const int light = b.add_light(Json::parse(
        R"({"type": "point", "color": [1, 0.5, 0.25], "intensity": 40, "range": 12, "name": "x"})"));
    b.add_node({.light = light, .translation = glm::dvec3(1, 2, 3), .name = "lamp"});
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.lights.size(), 1u);
    EXPECT_EQ(map.lights[0].kind, map::LightKind::point);
    EXPECT_EQ(map.lights[0].colour, glm::vec3(1, 0.5f, 0.25f));
    EXPECT_EQ(map.lights[0].intensity, 40);
    EXPECT_EQ(map.lights[0].range_m, 12);
    EXPECT_EQ(map.lights[0].position, glm::vec3(1, -3, 2));
    EXPECT_EQ(map.lights[0].name, "lamp");
}

TEST(Light, DefaultsAreTheExtensions) {
    GltfBuilder b;
    b.add_node({.light = b.add_light(Json::parse(R"({"type": "spot", "spot": {}})"))});
    const map::Light light = expect_accepted(b.import()).lights.at(0);
    EXPECT_EQ(light.colour, glm::vec3(1));
    EXPECT_EQ(light.intensity, 1);
    EXPECT_EQ(light.range_m, 0);
    EXPECT_EQ(light.inner_cone_radians, 0);
    EXPECT_FLOAT_EQ(light.outer_cone_radians, static_cast<float>(std::numbers::pi / 4));
}

TEST(Light, ShinesAlongMinusZOfItsNode) {
    GltfBuilder b;
    const int spot = b.add_light(
        Json::parse(R"({"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}})"));
    b.add_node({.light = spot});
    Map map = expect_accepted(b.import());
    EXPECT_EQ(map.lights.at(0).kind, map::LightKind::spot);
    expect_near(map.lights[0].direction, {0, 1, 0}, rounding);  // glTF (0, 0, -1)
    EXPECT_EQ(map.lights[0].inner_cone_radians, 0.25f);
    EXPECT_EQ(map.lights[0].outer_cone_radians, 0.5f);
    // A quarter turn about -x: it shines down, whatever the scale.
    b.json["nodes"] = Json::array();
    b.add_node({.light = spot,
                .rotation = glm::dvec4(-std::numbers::sqrt2 / 2, 0, 0, std::numbers::sqrt2 / 2),
                .scale = glm::dvec3(3, 4, 5)});
    map = expect_accepted(b.import());
    expect_near(map.lights.at(0).direction, {0, 0, -1}, rounding);
}

TEST(Light, MayStandOnAMeshNodeAndBeUsedTwice) {
    GltfBuilder b;
    const int light = b.add_light(Json::parse(R"({"type": "directional"})"));
    b.add_node({.mesh = b.add_mesh(ground(1)), .light = light});
    b.add_node({.light = light});
    b.add_node({.light = light, .role = "ignore"});
    const Map map = expect_accepted(b.import());
    EXPECT_EQ(map.lights.size(), 2u);
    EXPECT_EQ(map.objects.size(), 1u);
    EXPECT_EQ(map.lights[0].kind, map::LightKind::directional);
}

TEST(Light, BadOnesAreRefused) {
    const auto import_light = [](const char* text) {
        GltfBuilder b;
        b.add_node({.light = b.add_light(Json::parse(text)), .name = "lamp"});
        return b.import();
    };
    for (const char* text :
         {R"({"type": "area"})", R"({"type": "point", "intensity": -1})",
          R"({"type": "point", "intensity": 1e39})", R"({"type": "point", "range": -1})",
          R"({"type": "point", "color": [1, 1e39, 0]})", R"({"type": "point", "color": [1, -1, 0]})",
          R"({"type": "spot", "spot": {"outerConeAngle": 1e39}})",
          R"({"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.25}})",
          R"({"type": "spot", "spot": {"innerConeAngle": -1}})"}) {
        SCOPED_TRACE(text);
        expect_refused(import_light(text), {"map.gltf", "light 0"});
    }
    for (const char* text :
         {"{}", "3", "[]", R"({"type": 5})", R"({"type": "spot"})", R"({"type": "point", "color": [1]})",
          R"({"type": "point", "intensity": "high"})"}) {
        SCOPED_TRACE(text);
        expect_refused(import_light(text), {"map.gltf", "light 0"});
    }
}

TEST(Light, NodeNamingNoLightIsRefused) {
    GltfBuilder b;
    b.add_node({.light = b.add_light(Json::parse(R"({"type": "point"})"))});
    for (const char* reference : {"1", "-1", "4294967296", "\"0\"", "0.5"}) {
        SCOPED_TRACE(reference);
        b.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = Json::parse(reference);
        expect_refused(b.import(), {"map.gltf", "node 0", "light"});
    }
    b.json["nodes"][0]["extensions"]["KHR_lights_punctual"] = Json::object();
    expect_refused(b.import(), {"map.gltf", "node 0", "light"});
}

}  // namespace
}  // namespace drtv::test
