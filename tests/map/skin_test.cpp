// Skinned meshes stand where their joints hold them, whatever their own node says (glTF 2.0, 3.7.3.3).
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <glm/mat4x4.hpp>

#include <array>

namespace drtv::test {
namespace {

using map::Map;

glm::mat4 moved(const glm::vec3& by) {
    glm::mat4 matrix(1);
    matrix[3] = glm::vec4(by, 1);
    return matrix;
}

// A triangle at the origin; its first corner hangs on joint 0, its second on joint 1, its third on both
// alike.
struct Rig {
    GltfBuilder b;
    int joint0;
    int joint1;
    int body;

    explicit Rig(std::vector<float> weights = {1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0},
                 std::vector<std::uint8_t> joints = {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}) {
        joint1 = b.add_node({.translation = glm::dvec3(0, 8, 0), .name = "tail"});
        joint0 = b.add_node({.translation = glm::dvec3(4, 0, 0), .children = {joint1}, .name = "root"});
        const int mesh = b.add_mesh(triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1}));
        Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
        attributes["JOINTS_0"] = b.add_values(joints, gltf_u8, "VEC4");
        attributes["WEIGHTS_0"] = b.add_values(weights, gltf_f32, "VEC4");
        b.json["skins"] = Json::array({Json::object({{"joints", {joint0, joint1}}})});
        body = b.add_node({.mesh = mesh, .translation = glm::dvec3(100, 100, 100), .name = "body"});
        b.json["nodes"][static_cast<std::size_t>(body)]["skin"] = 0;
    }

    void set_inverse_bind_matrices(const std::vector<glm::mat4>& matrices) {
        std::vector<float> numbers;
        for (const glm::mat4& matrix : matrices) {
            for (glm::length_t c = 0; c < 4; ++c) {
                for (glm::length_t r = 0; r < 4; ++r)
                    numbers.push_back(matrix[c][r]);
            }
        }
        const int view = b.add_view(numbers);
        b.json["skins"][0]["inverseBindMatrices"] = b.add_accessor(view, gltf_f32, "MAT4", matrices.size());
    }

    [[nodiscard]] std::array<glm::vec3, 3> corners() const {
        const Map map = expect_accepted(b.import());
        const WorldTriangle found = world_triangles(map, map.objects.at(0)).at(0);
        return {found.corners[0], found.corners[1], found.corners[2]};
    }
};

TEST(Skin, JointsPlaceVerticesAndTheNodeDoesNot) {
    const auto [a, b, c] = Rig().corners();
    expect_near(a, {4, 0, 0});
    expect_near(b, {5, 0, 8});   // both joints' translations; glTF's y is the world's z
    expect_near(c, {4, -1, 4});  // halfway
}

TEST(Skin, InverseBindMatricesTakeTheBindPoseAway) {
    Rig rig;
    rig.set_inverse_bind_matrices({moved({-4, 0, 0}), moved({-4, -8, 0})});
    const auto [a, b, c] = rig.corners();
    expect_near(a, {0, 0, 0});
    expect_near(b, {1, 0, 0});
    expect_near(c, {0, -1, 0});
}

// As Blender writes it: the armature's node moves the joints, and so the mesh.
TEST(Skin, ArmatureMovesTheMesh) {
    Rig rig;
    rig.set_inverse_bind_matrices({moved({-4, 0, 0}), moved({-4, -8, 0})});
    rig.b.add_node({.translation = glm::dvec3(20, 0, 0), .children = {rig.joint0, rig.body}});
    expect_near(rig.corners()[0], {20, 0, 0});
}

TEST(Skin, WeightsNeedNotSumToOne) {
    const auto corners = Rig({2, 0, 0, 0, 3, 0, 0, 0, 1, 1, 0, 0}).corners();
    expect_near(corners[1], {5, 0, 8});
    expect_near(corners[2], {4, -1, 4});
    expect_near(Rig({0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0}).corners()[0], {4, 0, 0});
}

TEST(Skin, OneMeshInTwoPosesIsTwoMeshes) {
    Rig rig;
    const int plain = rig.b.add_node({.mesh = 0, .translation = glm::dvec3(0, 0, 0), .name = "statue"});
    const Map map = expect_accepted(rig.b.import());
    ASSERT_EQ(map.objects.size(), 2u);
    ASSERT_GT(plain, 0);
    for (const map::Object& object : map.objects)
        expect_near(world_triangles(map, object).at(0).corners[0],
                    object.name == "statue" ? glm::vec3(0) : glm::vec3(4, 0, 0));
}

// Skins would get a small file around the limits on meshes.
TEST(Skin, ManySkinsOfALargeMeshAreRefused) {
    GltfBuilder b;
    Shape wide;
    for (int n = 0; n < 300'000; ++n)
        wide.positions.emplace_back(static_cast<float>(n % 3), 0, static_cast<float>(n % 2));
    const int mesh = b.add_mesh(wide);
    Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] =
        b.add_values(std::vector<std::uint8_t>(4 * wide.positions.size()), gltf_u8, "VEC4");
    attributes["WEIGHTS_0"] =
        b.add_values(std::vector<std::uint8_t>(4 * wide.positions.size()), gltf_u8, "VEC4", true);
    const int joint = b.add_node({});
    b.json["skins"] = Json::array();
    for (int n = 0; n < 80; ++n) {
        b.json["skins"].push_back({{"joints", {joint}}});
        const int node = b.add_node({.mesh = mesh});
        b.json["nodes"][static_cast<std::size_t>(node)]["skin"] = n;
    }
    expect_refused(import_files({{"map.glb", b.glb()}}, {"map.glb"}), {"posed meshes", "over the limit"});
}

TEST(Skin, BrokenSkinsAreToldByElement) {
    const auto refused = [](std::initializer_list<std::string> parts, const auto& edit) {
        Rig rig;
        edit(rig);
        expect_refused(rig.b.import(), parts);
    };
    refused({"node 2", "skin", "7"}, [](Rig& rig) { rig.b.json["nodes"][2]["skin"] = 7; });
    refused({"skin 0", "joints"}, [](Rig& rig) { rig.b.json["skins"][0].erase("joints"); });
    refused({"skin 0", "no joints"}, [](Rig& rig) { rig.b.json["skins"][0]["joints"] = Json::array(); });
    refused({"skin 0", "joints", "99"}, [](Rig& rig) { rig.b.json["skins"][0]["joints"] = {99}; });
    refused({"mesh 0, primitive 0", "vertex 1", "skin 0", "it has 1"},
            [](Rig& rig) { rig.b.json["skins"][0]["joints"] = {rig.joint0}; });
    refused({"skin 0", "2 joints", "1 inverse"},
            [](Rig& rig) { rig.set_inverse_bind_matrices({glm::mat4(1)}); });
    refused({"mesh 0, primitive 0", "no WEIGHTS_0"},
            [](Rig& rig) { rig.b.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0"); });
    refused({"mesh 0, primitive 0", "no JOINTS_0"},
            [](Rig& rig) { rig.b.json["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0"); });
}

}  // namespace
}  // namespace drtv::test
