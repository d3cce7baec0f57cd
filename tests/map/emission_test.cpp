// What shines: emissiveFactor, KHR_materials_emissive_strength, and the picture with coordinates of its own.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

namespace drtv::test {
namespace {

using map::Map;
using map::Material;

// Factor and strength are multiplied in double and rounded once.
constexpr float rounding = 1e-6f;

// A quad with a material whose json a test can write to.
struct Lamp {
    GltfBuilder b;
    int material = b.add_material({.name = "lamp"});
    Json& json = b.json["materials"][0];

    Lamp() { b.place(ground(1), "", material); }
    [[nodiscard]] tl::expected<Map, std::string> import() const { return b.import(); }
    [[nodiscard]] Material worn() const {
        const Map map = expect_accepted(import());
        return map.materials.at(map.meshes.at(0).primitives.at(0).material);
    }
    void set_strength(const Json& strength) {
        json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
    }
};

TEST(Emission, IsFactorTimesStrength) {
    Lamp lamp;
    lamp.json["emissiveFactor"] = {0.5, 0.25, 1};
    expect_near(lamp.worn().emission, {0.5f, 0.25f, 1}, rounding);
    lamp.set_strength(8);
    expect_near(lamp.worn().emission, {4, 2, 8}, rounding);
    lamp.set_strength(0);
    expect_near(lamp.worn().emission, {0, 0, 0});
    lamp.json["extensions"]["KHR_materials_emissive_strength"] = Json::object();
    expect_near(lamp.worn().emission, {0.5f, 0.25f, 1}, rounding);
}

TEST(Emission, IsNoneByDefaultWhateverTheStrength) {
    Lamp lamp;
    expect_near(lamp.worn().emission, {0, 0, 0});
    lamp.set_strength(1000);
    expect_near(lamp.worn().emission, {0, 0, 0});
    EXPECT_FALSE(lamp.worn().emission_texture.present());
}

TEST(Emission, MayBeAskedForByRequiredExtension) {
    Lamp lamp;
    lamp.b.json["extensionsRequired"] = {"KHR_materials_emissive_strength"};
    lamp.json["emissiveFactor"] = {1, 1, 1};
    lamp.set_strength(3);
    expect_near(lamp.worn().emission, {3, 3, 3}, rounding);
}

TEST(Emission, OutOfRangeIsRefused) {
    for (const double strength : {-1.0, -1e-9, 1e13}) {
        Lamp lamp;
        lamp.set_strength(strength);
        expect_refused(lamp.import(), {"map.gltf", "material 0 ('lamp')", "emissiveStrength", "[0, "});
    }
    for (const double factor : {-0.5, 1e13}) {
        Lamp lamp;
        lamp.json["emissiveFactor"] = {0, factor, 0};
        expect_refused(lamp.import(), {"map.gltf", "material 0 ('lamp')", "emissiveFactor", "[0, "});
    }
}

// Each within its range, both together over what a sector can hold.
TEST(Emission, OutOfRangeTogetherIsRefused) {
    Lamp lamp;
    lamp.json["emissiveFactor"] = {0, 1e12, 0};
    lamp.set_strength(1e12);
    expect_refused(lamp.import(), {"map.gltf", "material 0 ('lamp')"});
}

TEST(Emission, OfTheWrongTypeIsRefused) {
    Lamp lamp;
    lamp.set_strength("bright");
    expect_refused(lamp.import(),
                   {"map.gltf", "material 0", "KHR_materials_emissive_strength", "emissiveStrength"});
    Lamp pair;
    pair.json["emissiveFactor"] = {1, 1};
    expect_refused(pair.import(), {"map.gltf", "material 0", "emissiveFactor"});
    Lamp texture;
    texture.json["emissiveTexture"] = {{"index", 0}};
    expect_refused(texture.import(), {"map.gltf", "material 0", "emissiveTexture"});
}

TEST(EmissionTexture, HasItsOwnSetOfCoordinates) {
    Lamp lamp;
    const int picture = lamp.b.add_texture({2, 1, {255, 255, 255, 255, 0, 0, 0, 255}});
    lamp.json["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", picture}};
    lamp.json["emissiveFactor"] = {1, 1, 1};
    lamp.json["emissiveTexture"] = {{"index", picture}, {"texCoord", 1}};
    lamp.b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        lamp.b.add_values(std::vector<glm::vec2>{{7, 8}, {9, 8}, {9, 6}, {7, 6}}, gltf_f32, "VEC2");
    const std::vector<glm::vec2> first = {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
                                 second = {{7, 8}, {9, 8}, {9, 6}, {7, 6}};
    {
        const Map map = expect_accepted(lamp.import());
        EXPECT_EQ(map.meshes.at(0).primitives.at(0).uvs, first);
        EXPECT_EQ(map.meshes.at(0).primitives.at(0).emission_uvs, second);
    }
    // KHR_texture_transform has the last word on the set, and each texture its own transform.
    lamp.json["emissiveTexture"]["extensions"]["KHR_texture_transform"] = {
        {"texCoord", 0}, {"offset", {0.25, 0.5}}, {"scale", {2, 3}}};
    const Map map = expect_accepted(lamp.import());
    EXPECT_EQ(map.meshes.at(0).primitives.at(0).emission_uvs, first);
    const Material& material = map.materials.at(map.meshes.at(0).primitives.at(0).material);
    expect_near(material.emission_texture.u_from_uv, {2, 0, 0.25f}, rounding);
    expect_near(material.emission_texture.v_from_uv, {0, 3, 0.5f}, rounding);
    expect_near(material.base_texture.u_from_uv, {1, 0, 0});
    expect_near(material.base_texture.v_from_uv, {0, 1, 0});
}

TEST(EmissionTexture, WithoutCoordinatesShowsItsFirstTexel) {
    Lamp lamp;
    lamp.json["emissiveFactor"] = {1, 1, 1};
    lamp.json["emissiveTexture"] = {{"index", lamp.b.add_texture({1, 1, {9, 9, 9, 255}})}, {"texCoord", 3}};
    const Map map = expect_accepted(lamp.import());
    EXPECT_EQ(map.meshes.at(0).primitives.at(0).emission_uvs, std::vector<glm::vec2>(4, glm::vec2(0)));
    EXPECT_TRUE(map.meshes.at(0).primitives.at(0).uvs.empty());
}

TEST(EmissionTexture, WithoutFactorIsNotEvenDecoded) {
    Lamp lamp;
    lamp.b.json["images"] = Json::array(
        {{{"bufferView", lamp.b.add_view(bytes_of("no picture at all"))}, {"mimeType", "image/png"}}});
    lamp.b.json["textures"] = Json::parse(R"([{"source": 0}])");
    lamp.json["emissiveTexture"] = {{"index", 0}};
    const Map map = expect_accepted(lamp.import());
    EXPECT_TRUE(map.textures.empty());
    EXPECT_TRUE(map.meshes.at(0).primitives.at(0).emission_uvs.empty());
    lamp.json["emissiveFactor"] = {0, 0, 0.001};
    expect_refused(lamp.import(), {"map.gltf", "material 0 ('lamp')", "image 0"});
}

// Its alpha means nothing, even where the same picture cuts the surface out.
TEST(EmissionTexture, IsAveragedOverAllOfItsTexels) {
    Lamp lamp;
    const int picture = lamp.b.add_texture({2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
    lamp.json.update(
        {{"alphaMode", "MASK"}, {"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", picture}}}});
    lamp.json["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", picture}};
    const Map map = expect_accepted(lamp.import());
    const Material& material = map.materials.at(map.meshes.at(0).primitives.at(0).material);
    EXPECT_EQ(map.textures.at(material.base_texture.texture).coverage, map::Coverage::cutoff);
    EXPECT_EQ(map.textures.at(material.emission_texture.texture).coverage, map::Coverage::whole);
}

}  // namespace
}  // namespace drtv::test
