// KHR_materials_diffuse_transmission: factors count, pictures do not.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

namespace drtv::test {
namespace {

using map::Map;
using map::Material;

struct Pane {
    GltfBuilder b;
    int material = b.add_material({.name = "pane"});
    Json& extension = b.json["materials"][0]["extensions"]["KHR_materials_diffuse_transmission"];

    Pane() {
        extension = Json::object();
        b.place(ground(1), "", material);
    }
    [[nodiscard]] tl::expected<Map, std::string> import() const { return b.import(); }
    [[nodiscard]] Material worn() const {
        const Map map = expect_accepted(import());
        return map.materials.at(map.meshes.at(0).primitives.at(0).material);
    }
};

TEST(Transmission, FactorAndColourAreRead) {
    Pane pane;
    pane.extension = {{"diffuseTransmissionFactor", 0.25},
                      {"diffuseTransmissionColorFactor", {0.5, 1, 0.125}}};
    EXPECT_EQ(pane.worn().diffuse_transmission, 0.25f);
    EXPECT_EQ(pane.worn().diffuse_transmission_colour, glm::vec3(0.5f, 1, 0.125f));
}

TEST(Transmission, IsNoneOfWhiteByDefault) {
    Pane pane;
    EXPECT_EQ(pane.worn().diffuse_transmission, 0);
    pane.extension["diffuseTransmissionFactor"] = 1;
    EXPECT_EQ(pane.worn().diffuse_transmission, 1);
    EXPECT_EQ(pane.worn().diffuse_transmission_colour, glm::vec3(1));
    pane.b.json["materials"][0].erase("extensions");
    EXPECT_EQ(pane.worn().diffuse_transmission, 0);
}

TEST(Transmission, OutOfRangeIsRefused) {
    for (const double factor : {-0.25, 1.5, 1e30}) {
        Pane pane;
        pane.extension["diffuseTransmissionFactor"] = factor;
        expect_refused(pane.import(),
                       {"map.gltf", "material 0 ('pane')", "diffuseTransmissionFactor", "[0, 1]"});
    }
    for (const double colour : {-0.25, 1.5}) {
        Pane pane;
        pane.extension["diffuseTransmissionColorFactor"] = {0, 1, colour};
        expect_refused(pane.import(),
                       {"map.gltf", "material 0 ('pane')", "diffuseTransmissionColorFactor", "[0, 1]"});
    }
}

TEST(Transmission, OfTheWrongTypeIsRefused) {
    for (const Json& wrong : {Json{{"diffuseTransmissionFactor", "half"}},
                              Json{{"diffuseTransmissionColorFactor", {1, 1}}}, Json(7)}) {
        Pane pane;
        pane.extension = wrong;
        expect_refused(pane.import(), {"map.gltf", "material 0", "KHR_materials_diffuse_transmission"});
    }
}

TEST(Transmission, PicturesOfItAreIgnoredWithAWarning) {
    for (const std::string texture : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"}) {
        Pane pane;
        pane.b.json["images"] = Json::parse(R"([{"uri": "gone.png"}])");
        pane.b.json["textures"] = Json::parse(R"([{"source": 0}])");
        pane.extension = {{"diffuseTransmissionFactor", 0.5}, {texture, {{"index", 0}}}};
        pane.b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
        const Map map = expect_accepted(pane.import());
        EXPECT_TRUE(map.textures.empty());
        EXPECT_EQ(map.materials.at(map.meshes.at(0).primitives.at(0).material).diffuse_transmission, 0.5f);
        ASSERT_EQ(map.warnings.size(), 1u);
        for (const std::string& part :
             {std::string("map.gltf"), std::string("material 0 ('pane')"), texture, std::string("ignored")})
            EXPECT_NE(map.warnings[0].find(part), std::string::npos) << map.warnings[0];
    }
}

}  // namespace
}  // namespace drtv::test
