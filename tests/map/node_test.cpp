// Nodes: hierarchies, transforms, instances, scenes, several files.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <cmath>
#include <numbers>

namespace drtv::test {
namespace {

using map::Map;

// sin and cos of quarter turns in double, products of a few matrices, rounded to float.
constexpr float rounding = 2e-6f;

const double half_root = std::numbers::sqrt2 / 2;

TEST(Importer, GltfAxesBecomeWorldAxes) {
    GltfBuilder b;
    b.place(triangle({1, 2, 3}, {4, 2, 3}, {1, 7, 3}));
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.objects.size(), 1u);
    const auto triangles = world_triangles(map, map.objects[0]);
    ASSERT_EQ(triangles.size(), 1u);
    expect_near(triangles[0].corners[0], {1, -3, 2});
    expect_near(triangles[0].corners[1], {4, -3, 2});
    expect_near(triangles[0].corners[2], {1, -3, 7});
    expect_near(triangles[0].front, {0, -1, 0});
    expect_near(map.objects[0].bounds.low, {1, -3, 2});
    expect_near(map.objects[0].bounds.high, {4, -3, 7});
}

TEST(Importer, GroundPlaneLooksUp) {
    GltfBuilder b;
    b.place(ground(5, 1));
    const Map map = expect_accepted(b.import());
    for (const WorldTriangle& t : world_triangles(map, map.objects.at(0)))
        expect_near(t.front, {0, 0, 1});
    expect_near(map.objects[0].bounds.low, {-5, -5, 1});
    expect_near(map.objects[0].bounds.high, {5, 5, 1});
}

TEST(Importer, BoxFacesOutwards) {
    GltfBuilder b;
    b.place(box({1, 2, 3}, {2, 4, 6}));
    const Map map = expect_accepted(b.import());
    const glm::vec3 centre(1.5f, -4.5f, 3);
    const auto triangles = world_triangles(map, map.objects.at(0));
    EXPECT_EQ(triangles.size(), 12u);
    for (const WorldTriangle& t : triangles)
        EXPECT_GT(glm::dot(t.front, t.corners[0] - centre), 0);
}

TEST(Importer, NegativeScaleKeepsTheFront) {
    for (const glm::dvec3& scale : {glm::dvec3(-1, 1, 1), glm::dvec3(1, 1, -1), glm::dvec3(-2, 3, 4),
                                    glm::dvec3(-1, 1, -1), glm::dvec3(-1, 2, -3)}) {
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(ground(1)), .scale = scale});
        const Map map = expect_accepted(b.import());
        for (const WorldTriangle& t : world_triangles(map, map.objects.at(0)))
            expect_near(t.front, {0, 0, 1});
    }
}

TEST(Importer, MirroringHeightTurnsTheGroundOver) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(ground(1)), .scale = glm::dvec3(1, -1, 1)});
    const Map map = expect_accepted(b.import());
    for (const WorldTriangle& t : world_triangles(map, map.objects.at(0)))
        expect_near(t.front, {0, 0, -1});
}

TEST(Importer, MirroredBoxStillFacesOutwards) {
    GltfBuilder b;
    const int leaf = b.add_node({.mesh = b.add_mesh(box({-1, -1, -1}, {1, 1, 1})),
                                 .rotation = glm::dvec4(0, 0, half_root, half_root),
                                 .scale = glm::dvec3(1, 2, -1)});
    b.add_node({.translation = glm::dvec3(10, 0, 0), .scale = glm::dvec3(3, 1, 1), .children = {leaf}});
    const Map map = expect_accepted(b.import());
    for (const WorldTriangle& t : world_triangles(map, map.objects.at(0)))
        EXPECT_GT(glm::dot(t.front, t.corners[0] - glm::vec3(10, 0, 0)), 0);
}

TEST(Importer, HierarchyAppliesScaleThenRotationThenTranslation) {
    GltfBuilder b;
    // The child's point (1, 0, 0) -> scaled (2, 0, 0) -> moved (2, 1, 0); the parent turns a quarter about y:
    // (0, 1, -2), and moves.
    const int child = b.add_node({.mesh = b.add_mesh(triangle({1, 0, 0}, {0, 0, 0}, {0, 0, 1})),
                                  .translation = glm::dvec3(0, 1, 0),
                                  .scale = glm::dvec3(2, 3, 4)});
    b.add_node({.translation = glm::dvec3(100, 0, 0),
                .rotation = glm::dvec4(0, half_root, 0, half_root),
                .children = {child}});
    const Map map = expect_accepted(b.import());
    const auto triangles = world_triangles(map, map.objects.at(0));
    expect_near(triangles.at(0).corners[0], {100, 2, 1}, rounding);
    expect_near(triangles.at(0).corners[1], {100, 0, 1}, rounding);
    expect_near(triangles.at(0).corners[2], {104, 0, 1}, rounding);
}

TEST(Importer, MatrixMayShear) {
    GltfBuilder b;
    // x' = x + 2 y, so that (0, 1, 0) -> (2, 1, 0).
    b.add_node({.mesh = b.add_mesh(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})),
                .matrix = {1, 0, 0, 0, 2, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}});
    const Map map = expect_accepted(b.import());
    const auto triangles = world_triangles(map, map.objects.at(0));
    expect_near(triangles.at(0).corners[0], {5, -7, 6});
    expect_near(triangles.at(0).corners[1], {6, -7, 6});
    expect_near(triangles.at(0).corners[2], {7, -7, 7});
}

// As an inverse in single precision has it.
TEST(Importer, MatrixMayBeAffineButForRounding) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})),
                .matrix = {1, 0, 0, 1e-9, 0, 1, 0, -1e-8, 0, 0, 1, 0, 5, 6, 7, 0.9999999}});
    const Map map = expect_accepted(b.import());
    expect_near(world_triangles(map, map.objects.at(0)).at(0).corners[0], {5, -7, 6});
}

TEST(Importer, RotationOfAnyLengthIsNormalised) {
    GltfBuilder b;
    b.add_node(
        {.mesh = b.add_mesh(triangle({1, 0, 0}, {0, 0, 0}, {0, 1, 0})), .rotation = glm::dvec4(0, 3, 0, 3)});
    const Map map = expect_accepted(b.import());
    expect_near(world_triangles(map, map.objects.at(0)).at(0).corners[0], {0, 1, 0}, rounding);
}

TEST(Importer, MeshScaledFlatKeepsItsSurface) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(box({-1, 0, -1}, {1, 2, 1})),
                .translation = glm::dvec3(5, 3, 0),
                .scale = glm::dvec3(2, 0, 1)});
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.objects.size(), 1u);
    const map::Object& object = map.objects[0];
    EXPECT_GT(std::abs(glm::determinant(glm::mat3(object.world_from_object))), 0.5f)
        << "instancing needs an inverse";
    expect_near(object.bounds.low, {3, -1, 3});
    expect_near(object.bounds.high, {7, 1, 3});
}

TEST(Importer, ThousandUsesKeepTheMeshOnce) {
    GltfBuilder b;
    const int mesh = b.add_mesh(box({0, 0, 0}, {1, 1, 1}));
    for (int n = 0; n < 1000; ++n)
        b.add_node({.mesh = mesh, .translation = glm::dvec3(2 * n, 0, 0)});
    const Map map = expect_accepted(b.import());
    EXPECT_EQ(map.meshes.size(), 1u);
    EXPECT_EQ(map.objects.size(), 1000u);
}

TEST(Importer, EqualMeshesOfSeveralFilesAreKeptOnce) {
    GltfBuilder b, c;
    b.place(box({0, 0, 0}, {1, 1, 1}), "", b.add_material({.colour = {0.5f, 0, 0, 1}}));
    c.add_material({.colour = {0, 1, 0, 1}});
    c.place(ground(3));
    c.place(box({0, 0, 0}, {1, 1, 1}), "", c.add_material({.colour = {0.5f, 0, 0, 1}}));
    const Map map = expect_accepted(
        import_files({{"b.gltf", bytes_of(b.gltf())}, {"c.glb", c.glb()}}, {"b.gltf", "c.glb"}));
    EXPECT_EQ(map.objects.size(), 3u);
    EXPECT_EQ(map.meshes.size(), 2u);
}

TEST(Importer, FilesInFoldersFindTheirBuffersBesideThem) {
    GltfBuilder b;
    b.place(ground(1));
    const Map map = expect_accepted(import_files(
        {{"east/map.gltf", bytes_of(b.gltf("parts/a%20b+c.bin"))}, {"east/parts/a b+c.bin", b.bin}},
        {"east/map.gltf"}));
    EXPECT_EQ(map.objects.size(), 1u);
}

TEST(Importer, NoFilesAreAnEmptyMap) {
    EXPECT_TRUE(expect_accepted(import_files({}, {})).objects.empty());
}

TEST(Importer, InstancesArePlacedByTheirTransforms) {
    GltfBuilder b;
    const int mesh = b.add_mesh(triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 0}));
    const int translations = b.add_values(std::vector<glm::vec3>{{0, 0, 0}, {10, 0, 0}}, gltf_f32, "VEC3");
    // Quarter turns about y as normalised bytes: nothing, and a half turn.
    const int rotations =
        b.add_values(std::vector<std::int8_t>{0, 0, 0, 127, 0, 127, 0, 0}, gltf_i8, "VEC4", true);
    const int scales = b.add_values(std::vector<glm::vec3>{{1, 1, 1}, {3, 2, 1}}, gltf_f32, "VEC3");
    const int node = b.add_node({.mesh = mesh, .translation = glm::dvec3(0, 100, 0), .name = "trees"});
    b.json["nodes"][static_cast<std::size_t>(node)]["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", {{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}}}};
    b.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.objects.size(), 2u);
    EXPECT_EQ(map.meshes.size(), 1u);
    for (const map::Object& object : map.objects) {
        const auto t = world_triangles(map, object).at(0);
        if (object.name == "trees[0]") {
            expect_near(t.corners[0], {1, 0, 100});
            expect_near(t.corners[1], {0, 0, 101});
        } else {
            EXPECT_EQ(object.name, "trees[1]");
            expect_near(t.corners[0], {7, 0, 100}, rounding);
            expect_near(t.corners[1], {10, 0, 102}, rounding);
        }
    }
}

TEST(Importer, InstancingWithoutInstancesPlacesNothing) {
    GltfBuilder b;
    b.add_instances(b.add_mesh(ground(1)), {{0, 0, 0}});
    b.json["accessors"].back()["count"] = 0;
    EXPECT_TRUE(expect_accepted(b.import()).objects.empty());
}

TEST(Importer, OnlyTheDefaultSceneIsTaken) {
    GltfBuilder b;
    const int mesh = b.add_mesh(ground(1));
    for (int n = 0; n < 3; ++n)
        b.add_node({.mesh = mesh, .name = std::string(1, static_cast<char>('a' + n))});
    b.json["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [1]}, {}])");
    b.json["scene"] = 1;
    Map map = expect_accepted(b.import());
    ASSERT_EQ(map.objects.size(), 1u);
    EXPECT_EQ(map.objects[0].name, "b");
    b.json.erase("scene");
    map = expect_accepted(b.import());
    ASSERT_EQ(map.objects.size(), 1u);
    EXPECT_EQ(map.objects[0].name, "a");
    b.json["scene"] = 2;
    EXPECT_TRUE(expect_accepted(b.import()).objects.empty());
    b.json["scene"] = 0;
    b.json["scenes"] = Json::array();
    b.json.erase("scene");
    EXPECT_EQ(expect_accepted(b.import()).objects.size(), 3u) << "without scenes all roots count";
}

TEST(Importer, ChainOfAHundredThousandNodesIsFine) {
    GltfBuilder b;
    const int mesh = b.add_mesh(ground(1));
    constexpr int length = 100000;
    Json nodes = Json::array();
    for (int n = 0; n + 1 < length; ++n)
        nodes.push_back({{"children", Json::array({n + 1})}, {"translation", {0.001, 0, 0}}});
    nodes.push_back({{"mesh", mesh}});
    b.json["nodes"] = std::move(nodes);
    const Map map = expect_accepted(b.import());
    ASSERT_EQ(map.objects.size(), 1u);
    EXPECT_NEAR(map.objects[0].bounds.high.x, 1 + 99.999, 1e-4);
}

TEST(Importer, FarAwayObjectKeepsMillimetres) {
    GltfBuilder b;
    const int child = b.add_node({.mesh = b.add_mesh(ground(1)), .translation = glm::dvec3(-1e8, 0, 0)});
    b.add_node({.translation = glm::dvec3(1e8 + 0.125, 0, 0), .children = {child}});
    EXPECT_FLOAT_EQ(expect_accepted(b.import()).objects.at(0).bounds.high.x, 1.125f);
}

}  // namespace
}  // namespace drtv::test
