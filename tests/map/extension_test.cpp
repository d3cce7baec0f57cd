// Extensions that change what a map is: honoured, or told.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <algorithm>

namespace drtv::test {
namespace {

using map::Map;
using map::Material;

Map import(const GltfBuilder& b) {
    return expect_accepted(b.import());
}

Material worn(const GltfBuilder& b) {
    const Map map = import(b);
    return map.materials.at(map.meshes.at(0).primitives.at(0).material);
}

struct Pane {
    GltfBuilder b;
    Json& extension;

    explicit Pane(const char* name)
        : extension((b.add_material({.name = "pane"}), b.json["materials"][0]["extensions"][name])) {
        extension = Json::object();
        b.place(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), "", 0);
    }
};

TEST(SpecularGlossiness, DiffuseColourAndPictureReplaceTheCores) {
    Pane pane("KHR_materials_pbrSpecularGlossiness");
    pane.b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 1};
    pane.extension["diffuseFactor"] = {0.25, 0.5, 0.125, 0.75};
    EXPECT_EQ(worn(pane.b).base_colour, glm::vec4(0.25f, 0.5f, 0.125f, 0.75f));
    EXPECT_FALSE(worn(pane.b).base_texture.present());
    const int texture = pane.b.add_texture({.rgba = {255, 0, 0, 255}});
    pane.extension["diffuseTexture"] = {
        {"index", texture}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}}}}}};
    const Material textured = worn(pane.b);
    ASSERT_TRUE(textured.base_texture.present());
    EXPECT_EQ(textured.base_texture.u_from_uv, glm::vec3(1, 0, 0.5f));
    EXPECT_FALSE(import(pane.b).meshes.at(0).primitives.at(0).uvs.empty());
}

TEST(SpecularGlossiness, IsWhiteByDefaultAndKeepsTheCoresPictureOut) {
    Pane pane("KHR_materials_pbrSpecularGlossiness");
    pane.b.json["materials"][0]["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0, 0, 0, 1}},
        {"baseColorTexture", {{"index", pane.b.add_texture({.rgba = {0, 0, 0, 255}})}}}};
    EXPECT_EQ(worn(pane.b).base_colour, glm::vec4(1));
    EXPECT_FALSE(worn(pane.b).base_texture.present());
}

TEST(SpecularGlossiness, WrongValuesAreRefused) {
    for (const Json& factor : {Json{2, 0, 0, 1}, Json{0, 0, 0, -1}}) {
        Pane pane("KHR_materials_pbrSpecularGlossiness");
        pane.extension["diffuseFactor"] = factor;
        expect_refused(pane.b.import(), {"material 0 ('pane')", "diffuseFactor", "[0, 1]"});
    }
    for (const char* wrong : {R"({"diffuseFactor": [1, 1]})", R"({"diffuseTexture": 3})",
                              R"({"diffuseTexture": {"index": 7}})", R"({"diffuseTexture": {}})"}) {
        Pane pane("KHR_materials_pbrSpecularGlossiness");
        pane.extension = Json::parse(wrong);
        expect_refused(pane.b.import(), {"material 0", "KHR_materials_pbrSpecularGlossiness"});
    }
}

TEST(ClearGlass, FactorAndPictureAreRead) {
    Pane pane("KHR_materials_transmission");
    EXPECT_EQ(worn(pane.b).transmission, 0);
    pane.extension["transmissionFactor"] = 0.75;
    EXPECT_EQ(worn(pane.b).transmission, 0.75f);
    EXPECT_FALSE(worn(pane.b).transmission_texture.present());
    pane.extension["transmissionTexture"] = {{"index", pane.b.add_texture({.rgba = {128, 0, 0, 255}})},
                                             {"texCoord", 1}};
    const std::vector<glm::vec2> uvs = {{0.5f, 0}, {1, 0}, {1, 1}, {0, 1}};
    pane.b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        pane.b.add_values(uvs, gltf_f32, "VEC2");
    EXPECT_TRUE(worn(pane.b).transmission_texture.present());
    EXPECT_EQ(import(pane.b).meshes.at(0).primitives.at(0).transmission_uvs, uvs);
    // Of no glass the picture does not count.
    pane.extension["transmissionFactor"] = 0;
    EXPECT_FALSE(worn(pane.b).transmission_texture.present());
}

TEST(ClearGlass, WrongValuesAreRefused) {
    for (const double factor : {-0.5, 1.5}) {
        Pane pane("KHR_materials_transmission");
        pane.extension["transmissionFactor"] = factor;
        expect_refused(pane.b.import(), {"material 0 ('pane')", "transmissionFactor", "[0, 1]"});
    }
    for (const char* wrong : {R"({"transmissionFactor": "x"})", R"({"transmissionTexture": {"index": 7}})"}) {
        Pane pane("KHR_materials_transmission");
        pane.extension = Json::parse(wrong);
        expect_refused(pane.b.import(), {"material 0", "KHR_materials_transmission"});
    }
}

Json& visibility_of(GltfBuilder& b, int node) {
    return b.json["nodes"][static_cast<std::size_t>(node)]["extensions"]["KHR_node_visibility"]["visible"];
}

TEST(NodeVisibility, WhatIsHiddenIsNotThereNorAreItsChildren) {
    GltfBuilder b;
    b.place(ground(1));
    const int roof = b.place(ground(2, 3));
    const int lamp = b.add_node({.light = b.add_light({{"type", "point"}})});
    const int parent = b.add_node({.mesh = b.add_mesh(box({0, 0, 0}, {1, 1, 1})), .children = {roof, lamp}});
    EXPECT_EQ(import(b).objects.size(), 3u);
    visibility_of(b, parent) = true;
    EXPECT_EQ(import(b).objects.size(), 3u);
    visibility_of(b, parent) = false;
    EXPECT_EQ(import(b).objects.size(), 1u);
    EXPECT_TRUE(import(b).lights.empty());
    // What a child says does not show it again.
    visibility_of(b, roof) = true;
    EXPECT_EQ(import(b).objects.size(), 1u);
    b.json["nodes"][static_cast<std::size_t>(parent)]["extensions"]["KHR_node_visibility"] = Json::object();
    EXPECT_EQ(import(b).objects.size(), 3u);
}

// They are never seen, and are hidden so that they are not in the way.
TEST(NodeVisibility, ProbesAndVolumesCountAllTheSame) {
    GltfBuilder b;
    const int probe = b.add_node({.role = "probe"});
    const int volume = b.place(box({0, 0, 0}, {1, 1, 1}), "no_probes");
    visibility_of(b, probe) = false;
    visibility_of(b, volume) = false;
    EXPECT_EQ(import(b).probes.size(), 1u);
    EXPECT_EQ(import(b).volumes.size(), 1u);
    EXPECT_TRUE(import(b).objects.empty());
}

TEST(NodeVisibility, OfAWrongTypeIsRefused) {
    GltfBuilder b;
    visibility_of(b, b.place(ground(1))) = 0;
    expect_refused(b.import(), {"node 0", "KHR_node_visibility"});
}

// With and without scenes, as a root or as a child of another node.
TEST(LevelsOfDetail, CoarserOnesAreNotThere) {
    for (const bool with_scene : {false, true}) {
        for (const bool as_child : {false, true}) {
            GltfBuilder b;
            const int hull = b.place(box({-9, 0, -9}, {9, 9, 9}));
            const int coarsest = b.place(box({-20, 0, -20}, {20, 9, 20}));
            const int tower = b.place(box({-2, 0, -2}, {2, 9, 2}));
            b.json["nodes"][static_cast<std::size_t>(tower)]["extensions"]["MSFT_lod"]["ids"] = {hull,
                                                                                                 coarsest};
            Json roots = {tower};
            if (as_child)
                b.add_node({.children = {hull}});
            else
                roots.push_back(hull);
            if (with_scene) {
                b.json["scenes"] = {{{"nodes", roots}}};
            } else {
                b.json["scenes"] = Json::array();
            }
            const Map map = import(b);
            ASSERT_EQ(map.objects.size(), 1u) << with_scene << as_child;
            EXPECT_EQ(map.objects.at(0).bounds.high.x, 2);
        }
    }
}

TEST(LevelsOfDetail, OfUnknownNodesAreRefused) {
    for (const char* wrong : {R"({"ids": [5]})", R"({"ids": 1})", R"({})"}) {
        GltfBuilder b;
        const int tower = b.place(ground(1));
        b.json["nodes"][static_cast<std::size_t>(tower)]["extensions"]["MSFT_lod"] = Json::parse(wrong);
        expect_refused(b.import(), {"node 0", "MSFT_lod"});
    }
}

std::size_t warnings_that_name(const Map& map, const std::string& name) {
    return static_cast<std::size_t>(std::ranges::count_if(
        map.warnings, [&](const std::string& sentence) { return sentence.find(name) != std::string::npos; }));
}

TEST(Extensions, WhatIsPassedOverIsToldOnce) {
    for (const char* name : {"KHR_materials_volume", "KHR_materials_diffuse_roughness", "EXT_lights_ies",
                             "KHR_gaussian_splatting", "ACME_displacement"}) {
        GltfBuilder b;
        b.place(ground(1));
        b.json["extensionsUsed"] = {name, name, "KHR_materials_ior"};
        const Map map = import(b);
        EXPECT_EQ(warnings_that_name(map, name), 1u) << name;
        EXPECT_EQ(map.warnings.size(), 1u);
    }
}

TEST(Extensions, GlossAndWhatHasAFallbackNeedNoWord) {
    GltfBuilder b;
    b.place(ground(1));
    b.json["extensionsUsed"] = {"KHR_materials_ior",          "KHR_materials_specular",
                                "KHR_materials_clearcoat",    "KHR_materials_sheen",
                                "KHR_materials_iridescence",  "KHR_materials_anisotropy",
                                "KHR_texture_basisu",         "KHR_draco_mesh_compression",
                                "KHR_node_visibility",        "MSFT_lod",
                                "KHR_materials_transmission", "KHR_materials_pbrSpecularGlossiness"};
    EXPECT_TRUE(import(b).warnings.empty());
}

}  // namespace
}  // namespace drtv::test
