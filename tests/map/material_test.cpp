// Materials: factor, texture, vertex colours, transforms of coordinates, MASK, sides, sharing.
#include "bakerd/map/texture.h"
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace drtv::test {
namespace {

using map::Map;
using map::Material;
using map::Texture;

// IEC 61966-2-1 rounded to float.
constexpr float rounding = 1e-6f;

// Linear values of the sRGB bytes below, by the standard's formula.
constexpr float linear_of_10 = 10 / 255.0f / 12.92f, linear_of_128 = 0.21586050f;

Picture two_by_one(std::vector<std::uint8_t> rgba) {
    return {2, 1, std::move(rgba)};
}

// The material of the only object of a quad that wears it.
struct Worn {
    Map map;
    const map::Primitive& primitive() const { return map.meshes.at(map.objects.at(0).mesh).primitives.at(0); }
    const Material& material() const { return map.materials.at(primitive().material); }
    const Texture& texture() const { return map.textures.at(material().base_texture.texture); }
};

Worn wear(GltfBuilder b, int material) {
    b.place(ground(1), "", material);
    return {expect_accepted(b.import())};
}

TEST(Material, FactorIsLinear) {
    GltfBuilder b;
    const Worn worn = wear(b, b.add_material({.colour = {0.5f, 0.25f, 1, 0.75f}}));
    EXPECT_EQ(worn.material().base_colour, glm::vec4(0.5f, 0.25f, 1, 0.75f));
    EXPECT_EQ(worn.material().base_texture.texture, map::no_texture);
    EXPECT_FALSE(worn.material().alpha_mode == map::AlphaMode::mask);
    EXPECT_FALSE(worn.material().double_sided);
}

TEST(Material, WithoutOneIsWhite) {
    const Worn worn = wear({}, -1);
    EXPECT_EQ(worn.material().base_colour, glm::vec4(1));
    EXPECT_FALSE(worn.material().double_sided);
}

TEST(Material, MaskBringsItsCutoff) {
    GltfBuilder b;
    const Worn worn = wear(b, b.add_material({.mask_cutoff = 0.25, .double_sided = true}));
    EXPECT_TRUE(worn.material().alpha_mode == map::AlphaMode::mask);
    EXPECT_EQ(worn.material().alpha_cutoff, 0.25f);
    EXPECT_TRUE(worn.material().double_sided);
}

TEST(Material, MaskWithoutCutoffMeansOneHalf) {
    GltfBuilder b;
    const int material = b.add_material({.mask_cutoff = 0.25});
    b.json["materials"][0].erase("alphaCutoff");
    EXPECT_EQ(wear(b, material).material().alpha_cutoff, 0.5f);
}

TEST(Material, BlendIsKept) {
    GltfBuilder b;
    const int material = b.add_material({});
    b.json["materials"][0]["alphaMode"] = "BLEND";
    EXPECT_TRUE(wear(b, material).material().alpha_mode == map::AlphaMode::blend);
}

TEST(Texture, ColourIsSrgbAndAlphaLinear) {
    GltfBuilder b;
    const Worn worn = wear(b, b.add_material({.texture = b.add_texture({1, 1, {128, 10, 255, 128}})}));
    EXPECT_EQ(worn.texture().rgba, (std::vector<std::uint8_t>{128, 10, 255, 128}));
    const glm::vec4 colour = map::sample(worn.texture(), {0.5f, 0.5f});
    expect_near(glm::vec3(colour), {linear_of_128, linear_of_10, 1}, rounding);
    EXPECT_NEAR(colour.w, 128 / 255.0f, rounding);
}

TEST(Texture, CoordinatesComeWithTheMesh) {
    GltfBuilder b;
    const Worn worn =
        wear(b, b.add_material({.texture = b.add_texture(two_by_one({255, 0, 0, 255, 0, 255, 0, 255}))}));
    EXPECT_EQ(worn.primitive().uvs, (std::vector<glm::vec2>{{0, 1}, {1, 1}, {1, 0}, {0, 0}}));
    expect_near(glm::vec3(map::sample(worn.texture(), {0.25f, 0.5f})), {1, 0, 0}, rounding);
    expect_near(glm::vec3(map::sample(worn.texture(), {0.75f, 0.5f})), {0, 1, 0}, rounding);
    expect_near(glm::vec3(map::sample(worn.texture(), {0.5f, 0.5f})), {0.5f, 0.5f, 0},
                rounding);  // mixed after the decoding
}

TEST(Texture, RowsStandFromTheTop) {
    GltfBuilder b;
    const Worn worn =
        wear(b, b.add_material({.texture = b.add_texture({1, 2, {255, 0, 0, 255, 0, 0, 255, 255}})}));
    expect_near(glm::vec3(map::sample(worn.texture(), {0.5f, 0.25f})), {1, 0, 0}, rounding);
    expect_near(glm::vec3(map::sample(worn.texture(), {0.5f, 0.75f})), {0, 0, 1}, rounding);
}

TEST(Texture, WrapsAsTheSamplerSays) {
    const Picture picture = two_by_one({255, 0, 0, 255, 0, 255, 0, 255});
    const auto at = [&](Json sampler, float u) {
        GltfBuilder b;
        return glm::vec3(map::sample(
            wear(b, b.add_material({.texture = b.add_texture(picture, std::move(sampler))})).texture(),
            {u, 0.5f}));
    };
    expect_near(at(nullptr, 1.25f), {1, 0, 0}, rounding);              // repeat is the default
    expect_near(at({{"wrapS", 10497}}, -0.25f), {0, 1, 0}, rounding);  // repeat
    expect_near(at({{"wrapS", 33071}}, 7), {0, 1, 0}, rounding);       // clamp
    expect_near(at({{"wrapS", 33071}}, -7), {1, 0, 0}, rounding);      // clamp
    expect_near(at({{"wrapS", 33648}}, 1.25f), {0, 1, 0}, rounding);   // mirror
    expect_near(at({{"wrapS", 33648}}, -0.25f), {1, 0, 0}, rounding);  // mirror
}

TEST(Texture, AnyCoordinateIsSafe) {
    Texture texture;
    texture.width = texture.height = 1;
    texture.rgba = {255, 255, 255, 255};
    const float huge = std::numeric_limits<float>::max(), infinite = std::numeric_limits<float>::infinity(),
                nan = std::numeric_limits<float>::quiet_NaN();
    for (float u : {huge, -huge, infinite, -infinite, nan, 1e18f, -1e18f}) {
        for (map::Wrap wrap : {map::Wrap::repeat, map::Wrap::clamp, map::Wrap::mirror}) {
            texture.wrap_u = texture.wrap_v = wrap;
            expect_near(glm::vec3(map::sample(texture, {u, -u})), {1, 1, 1}, rounding);
        }
    }
}

TEST(Texture, SameOneInManyMaterialsIsKeptOnce) {
    GltfBuilder b;
    const Picture picture = two_by_one({1, 2, 3, 4, 5, 6, 7, 8});
    const int texture = b.add_texture(picture), copy = b.add_texture(picture),
              clamped = b.add_texture(picture, {{"wrapS", 33071}});
    for (int n = 0; n < 10; ++n)
        b.place(ground(1), "",
                b.add_material({.colour = {0.1f * static_cast<float>(n), 0, 0, 1},
                                .texture = n % 2 == 0 ? texture : copy}));
    EXPECT_EQ(expect_accepted(b.import()).textures.size(), 1u);
    b.place(ground(1), "", b.add_material({.texture = clamped}));
    EXPECT_EQ(expect_accepted(b.import()).textures.size(), 2u);
}

TEST(Texture, ManyMaterialsDecodeTheirPictureOnce) {
    // Decoding it 4000 times takes minutes.
    GltfBuilder b;
    const int texture = b.add_texture({1024, 1024, std::vector<std::uint8_t>(1024 * 1024 * 4, 200)});
    const int mesh = b.add_mesh(ground(1));
    const Json primitive = b.json["meshes"][0]["primitives"][0];
    for (int n = 0; n < 4000; ++n) {
        b.json["meshes"][0]["primitives"].push_back(primitive);
        b.json["meshes"][0]["primitives"].back()["material"] =
            b.add_material({.colour = {static_cast<float>(n) / 4000, 0, 0, 1}, .texture = texture});
    }
    b.add_node({.mesh = mesh});
    EXPECT_EQ(expect_accepted(b.import()).textures.size(), 1u);
}

TEST(Texture, MissingFromAMaterialThatNoneWearsIsNoHarm) {
    GltfBuilder b;
    b.json["images"] = Json::parse(R"([{"uri": "gone.png"}])");
    b.json["textures"] = Json::parse(R"([{"source": 0}, {}])");
    b.add_material({.texture = 0});
    b.add_material({.texture = 1});
    b.place(ground(1));
    EXPECT_EQ(expect_accepted(b.import()).objects.size(), 1u);
}

TEST(Texture, WithoutCoordinatesShowsItsFirstTexel) {
    GltfBuilder b;
    Shape bare = ground(1);
    bare.uvs.clear();
    b.place(bare, "", b.add_material({.texture = b.add_texture({1, 1, {9, 9, 9, 255}})}));
    const Worn worn{expect_accepted(b.import())};
    EXPECT_EQ(worn.primitive().uvs, std::vector<glm::vec2>(4, glm::vec2(0)));
}

TEST(Texture, FileBesideTheDocumentIsRead) {
    GltfBuilder b;
    b.json["images"] = Json::parse(R"([{"uri": "tex/a%20b+c.png"}])");
    b.json["textures"] = Json::parse(R"([{"source": 0}])");
    b.place(ground(1), "", b.add_material({.texture = 0}));
    const Files files = {{"east/m.gltf", bytes_of(b.gltf())},
                         {"east/tex/a b+c.png", png_of({1, 1, {1, 2, 3, 4}})}};
    EXPECT_EQ(expect_accepted(import_files(files, {"east/m.gltf"})).textures.at(0).rgba,
              (std::vector<std::uint8_t>{1, 2, 3, 4}));
}

TEST(Texture, DataUriIsRead) {
    GltfBuilder b;
    b.json["images"][0]["uri"] = "data:image/png;base64," + base64_of(png_of({1, 1, {1, 2, 3, 4}}));
    b.json["textures"] = Json::parse(R"([{"source": 0}])");
    EXPECT_EQ(wear(b, b.add_material({.texture = 0})).texture().rgba,
              (std::vector<std::uint8_t>{1, 2, 3, 4}));
}

TEST(TextureTransform, AppliesOffsetRotationAndScale) {
    GltfBuilder b;
    const int material = b.add_material({.texture = b.add_texture({1, 1, {0, 0, 0, 255}})});
    Json& info = b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.1, 0.2}}, {"rotation", std::numbers::pi / 6}, {"scale", {2, 3}}};
    const Worn worn = wear(b, material);
    // translation * rotation * scale, with the extension's rotation (c s; -s c).
    const auto c = static_cast<float>(std::sqrt(3.0) / 2), s = 0.5f;
    expect_near(worn.material().base_texture.u_from_uv, {2 * c, 3 * s, 0.1f}, rounding);
    expect_near(worn.material().base_texture.v_from_uv, {-2 * s, 3 * c, 0.2f}, rounding);
}

TEST(TextureTransform, MayNameAnotherSetOfCoordinates) {
    GltfBuilder b;
    const int material = b.add_material({.texture = b.add_texture({1, 1, {0, 0, 0, 255}})});
    b.place(ground(1), "", material);
    Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_1"] = b.add_values(std::vector<glm::vec2>(4, glm::vec2(7, 8)), gltf_f32, "VEC2");
    Json& info = b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["texCoord"] = 1;
    const auto uv = [&] { return Worn{expect_accepted(b.import())}.primitive().uvs.at(0); };
    EXPECT_EQ(uv(), glm::vec2(7, 8));
    info["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}};
    EXPECT_EQ(uv(), glm::vec2(0, 1));
}

TEST(VertexColour, IsReadInAllItsForms) {
    const auto colour = [](int type, const std::string& shape, auto values, bool normalized) {
        GltfBuilder b;
        b.place(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
        b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            b.add_accessor(b.add_view(values, 4 * (type == gltf_f32   ? 4
                                                   : type == gltf_u16 ? 2
                                                                      : 1)),
                           type, shape, 3, normalized);
        return expect_accepted(b.import()).meshes.at(0).primitives.at(0).colours.at(0);
    };
    std::vector<float> f(12, 0.5f);
    f[0] = 0.25f, f[1] = 2, f[2] = -1, f[3] = 0.75f;
    EXPECT_EQ(colour(gltf_f32, "VEC4", f, false), glm::vec4(0.25f, 1, 0, 0.75f));  // clamped
    EXPECT_EQ(colour(gltf_f32, "VEC3", f, false), glm::vec4(0.25f, 1, 0, 1));
    EXPECT_EQ(colour(gltf_u8, "VEC4", std::vector<std::uint8_t>(12, 51), true), glm::vec4(51 / 255.0f));
    EXPECT_EQ(colour(gltf_u8, "VEC3", std::vector<std::uint8_t>(12, 51), true),
              glm::vec4(glm::vec3(51 / 255.0f), 1));
    EXPECT_EQ(colour(gltf_u16, "VEC4", std::vector<std::uint16_t>(12, 13107), true),
              glm::vec4(13107 / 65535.0f));
}

}  // namespace
}  // namespace drtv::test
