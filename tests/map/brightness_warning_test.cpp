// An albedo that no real surface has is told, once a material, and by what the surface shows in the end.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

namespace drtv::test {
namespace {

// A bright material by default.
MaterialSource snow(float albedo = 0.96f) {
    return {.colour = {0.5f, albedo, 0.5f, 1}, .name = "snow"};
}

Shape tinted(float shade) {
    Shape shape = ground(1);
    shape.colours.assign(4, glm::vec4(glm::vec3(shade), 1));
    return shape;
}

std::vector<std::string> warnings_of(const GltfBuilder& b) {
    return expect_accepted(b.import()).warnings;
}

std::vector<std::string> warnings_of(const Shape& shape, const MaterialSource& material) {
    GltfBuilder b;
    b.place(shape, "", b.add_material(material));
    return warnings_of(b);
}

TEST(BrightnessWarning, NamesFileMaterialAndValue) {
    const auto warnings = warnings_of(ground(1), snow());
    ASSERT_EQ(warnings.size(), 1u);
    for (const char* part : {"map.gltf", "material 0 ('snow')", "0.96", "0.95"})
        EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
}

TEST(BrightnessWarning, BeginsAboveTheLimit) {
    EXPECT_TRUE(warnings_of(ground(1), snow(0.95f)).empty());
    EXPECT_EQ(warnings_of(ground(1), snow(1)).size(), 1u);
}

TEST(BrightnessWarning, SparesClearGlass) {
    GltfBuilder b;
    b.place(ground(1), "", b.add_material(snow(1)));
    auto& extension = b.json["materials"][0]["extensions"]["KHR_materials_transmission"];
    extension["transmissionFactor"] = 0.5;
    EXPECT_TRUE(warnings_of(b).empty());
    extension["transmissionFactor"] = 0.01;
    EXPECT_EQ(warnings_of(b).size(), 1u);
}

TEST(BrightnessWarning, SparesTheDefaultMaterial) {
    GltfBuilder b;
    b.place(ground(1));
    EXPECT_TRUE(warnings_of(b).empty());
}

TEST(BrightnessWarning, SparesAMaterialThatNoneWears) {
    GltfBuilder b;
    b.add_material(snow());
    b.place(ground(1));
    EXPECT_TRUE(warnings_of(b).empty());
}

TEST(BrightnessWarning, SparesWhatVertexColoursDarken) {
    EXPECT_TRUE(warnings_of(tinted(0.9f), snow()).empty());
    EXPECT_EQ(warnings_of(tinted(1), snow()).size(), 1u);
    Shape one_bright = tinted(0.5f);
    one_bright.colours[2] = glm::vec4(1);
    EXPECT_EQ(warnings_of(one_bright, snow()).size(), 1u);
}

TEST(BrightnessWarning, SparesWhatAPictureDarkens) {
    const auto with_texels = [](std::vector<std::uint8_t> rgba, std::optional<double> cutoff) {
        GltfBuilder b;
        MaterialSource material = snow(1);
        material.texture = b.add_texture({2, 1, std::move(rgba)});
        material.mask_cutoff = cutoff;
        b.place(ground(1), "", b.add_material(material));
        return warnings_of(b).size();
    };
    EXPECT_EQ(with_texels({200, 200, 200, 255, 9, 9, 9, 255}, {}), 0u);
    EXPECT_EQ(with_texels({200, 255, 200, 255, 9, 9, 9, 255}, {}), 1u);
    EXPECT_EQ(with_texels({200, 255, 200, 0, 9, 9, 9, 255}, {}), 1u);   // alpha has no say
    EXPECT_EQ(with_texels({200, 255, 200, 0, 9, 9, 9, 255}, 0.5), 0u);  // what is cut away is not seen
}

TEST(BrightnessWarning, ComesOnceHoweverManyThingsWearTheMaterial) {
    GltfBuilder b;
    const int bright = b.add_material(snow());
    const int mesh = b.add_mesh(ground(1), bright);
    b.add_primitive(mesh, ground(2), bright);
    for (int n = 0; n < 3; ++n)
        b.add_node({.mesh = mesh, .translation = glm::dvec3(9 * n, 0, 0)});
    b.place(ground(3), "", bright);
    EXPECT_EQ(warnings_of(b).size(), 1u);
    b.place(ground(4), "", b.add_material(snow(1)));
    EXPECT_EQ(warnings_of(b).size(), 2u);
}

TEST(BrightnessWarning, ComesOnceWhateverTheVertexColours) {
    GltfBuilder b;
    const int bright = b.add_material(snow(1));
    const int mesh = b.add_mesh(tinted(1), bright);
    b.add_primitive(mesh, tinted(0.98f), bright);
    b.add_node({.mesh = mesh});
    EXPECT_EQ(warnings_of(b).size(), 1u);
}

TEST(BrightnessWarning, ComesOnceWhateverTheName) {
    for (const std::string& name : {std::string(600, 's'), std::string("snow\tfresh")}) {
        GltfBuilder b;
        MaterialSource source = snow();
        source.name = name;
        const int bright = b.add_material(source);
        const int mesh = b.add_mesh(ground(1), bright);
        b.add_primitive(mesh, ground(2), bright);
        b.add_node({.mesh = mesh});
        EXPECT_EQ(warnings_of(b).size(), 1u) << name;
    }
}

}  // namespace
}  // namespace drtv::test
