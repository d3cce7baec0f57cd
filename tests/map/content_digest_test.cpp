// Digests: all that can change a bake changes them, and nothing else does.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <set>

namespace drtv::test {
namespace {

using map::Digest;
using map::Map;

// A village with one of everything.
GltfBuilder village() {
    GltfBuilder b;
    const int bricks = b.add_texture({2, 1, {200, 10, 10, 255, 10, 200, 10, 0}}, {{"wrapS", 33071}});
    const int wall = b.add_material(
        {.colour = {0.5f, 0.5f, 0.5f, 1}, .mask_cutoff = 0.5, .texture = bricks, .name = "wall"});
    const int leaves = b.add_material({.colour = {0, 0.5f, 0, 1}, .double_sided = true});
    Shape tinted = ground(20);
    tinted.colours.assign(4, glm::vec4(0.5f, 0.5f, 0.25f, 1));
    b.add_node({.mesh = b.add_mesh(tinted), .name = "ground"});
    b.add_node({.mesh = b.add_mesh(box({0, 0, 0}, {2, 2, 2}), wall),
                .translation = glm::dvec3(4, 0, 0),
                .name = "house"});
    b.add_instances(b.add_mesh(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), leaves),
                    {{1, 0, 0}, {2, 0, 0}}, {.name = "trees", .role = "vegetation"});
    b.add_node({.translation = glm::dvec3(0, 1, 0), .name = "lamp", .role = "probe"});
    b.add_node({.translation = glm::dvec3(8, 1, 0), .name = "other", .role = "probe"});
    b.add_node(
        {.mesh = b.add_mesh(box({4, 0, 0}, {6, 2, 2})), .name = "room", .role = "interior", .probe = "lamp"});
    b.add_node({.mesh = b.add_mesh(box({9, 0, 0}, {10, 1, 1})), .role = "no_probes"});
    b.add_node({.light = b.add_light(Json::parse(R"({"type": "spot", "spot": {}, "intensity": 5})")),
                .translation = glm::dvec3(0, 3, 0)});
    b.add_node({.light = b.add_light(Json::parse(R"({"type": "point", "intensity": 7})")),
                .translation = glm::dvec3(1, 3, 0)});
    b.add_node({.light = b.add_light(Json::parse(R"({"type": "directional"})"))});
    return b;
}

Digest content_of(const GltfBuilder& b) {
    return expect_accepted(b.import()).content;
}

Json& node(GltfBuilder& b, std::size_t n) {
    return b.json["nodes"][n];
}

// Where a float of accessor n lies in the buffer.
void put_float(GltfBuilder& b, std::size_t accessor, std::size_t element, float value) {
    const std::size_t view = b.json["accessors"][accessor]["bufferView"];
    std::memcpy(&b.bin[b.json["bufferViews"][view]["byteOffset"].get<std::size_t>() + 4 * element], &value,
                4);
}

using Edit = std::function<void(GltfBuilder&)>;
struct NamedEdit {
    const char* name;
    Edit edit;
};

TEST(ContentDigest, IsTheSameTwice) {
    EXPECT_EQ(content_of(village()), content_of(village()));
}

TEST(ContentDigest, ChangesWithAllThatABakeSees) {
    const std::vector<NamedEdit> edits = {
        {"a vertex",
         [](auto& b) {
             put_float(b, b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"], 1, 0.5f);
         }},
        {"a vertex colour",
         [](auto& b) {
             put_float(b, b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"], 1, 0.75f);
         }},
        {"a texture coordinate",
         [](auto& b) {
             put_float(b, b.json["meshes"][1]["primitives"][0]["attributes"]["TEXCOORD_0"], 0, 0.5f);
         }},
        {"a texture coordinate's transform",
         [](auto& b) {
             b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
                   ["KHR_texture_transform"]["rotation"] = 0.5;
         }},
        {"a triangle's winding",
         [](auto& b) {
             b.json["meshes"][0]["primitives"][0]["indices"] =
                 b.add_values(std::vector<std::uint32_t>{0, 2, 1, 0, 2, 3}, gltf_u32, "SCALAR");
         }},
        {"a triangle less",
         [](auto& b) {
             b.json["accessors"][b.json["meshes"][0]["primitives"][0]["indices"].template get<std::size_t>()]
                   ["count"] = 3;
         }},
        {"a colour",
         [](auto& b) { b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][0] = 0.25; }},
        {"a factor of the masked alpha",
         [](auto& b) { b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25; }},
        {"the cutoff", [](auto& b) { b.json["materials"][0]["alphaCutoff"] = 0.25; }},
        {"the mask", [](auto& b) { b.json["materials"][0]["alphaMode"] = "OPAQUE"; }},
        {"the sides", [](auto& b) { b.json["materials"][0]["doubleSided"] = true; }},
        {"blending", [](auto& b) { b.json["materials"][0]["alphaMode"] = "BLEND"; }},
        {"blending without a picture", [](auto& b) { b.json["materials"][1]["alphaMode"] = "BLEND"; }},
        {"a factor of the blended alpha",
         [](auto& b) {
             b.json["materials"][1]["alphaMode"] = "BLEND";
             b.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25;
         }},
        {"emission",
         [](auto& b) {
             b.json["materials"][1]["emissiveFactor"] = {0, 0.5, 0};
         }},
        {"emission's strength",
         [](auto& b) {
             b.json["materials"][1]["emissiveFactor"] = {0, 0.5, 0};
             b.json["materials"][1]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 9;
         }},
        {"emission's picture",
         [](auto& b) {
             b.json["materials"][1]["emissiveFactor"] = {0, 0.5, 0};
             b.json["materials"][1]["emissiveTexture"] = {{"index", 0}};
         }},
        {"emission's coordinates",
         [](auto& b) {
             b.json["materials"][1]["emissiveFactor"] = {0, 0.5, 0};
             b.json["materials"][1]["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
         }},
        {"the transform of emission's coordinates",
         [](auto& b) {
             b.json["materials"][1]["emissiveFactor"] = {0, 0.5, 0};
             b.json["materials"][1]["emissiveTexture"] = {{"index", 0}};
             b.json["materials"][1]["emissiveTexture"]["extensions"]["KHR_texture_transform"]["rotation"] =
                 0.5;
         }},
        {"transmission",
         [](auto& b) {
             b.json["materials"][1]["extensions"]["KHR_materials_diffuse_transmission"]
                   ["diffuseTransmissionFactor"] = 0.5;
         }},
        {"more transmission",
         [](auto& b) {
             b.json["materials"][1]["extensions"]["KHR_materials_diffuse_transmission"]
                   ["diffuseTransmissionFactor"] = 0.75;
         }},
        {"transmission's colour",
         [](auto& b) {
             b.json["materials"][1]["extensions"]["KHR_materials_diffuse_transmission"] = {
                 {"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {1, 0.5, 1}}};
         }},
        {"a texel",
         [](auto& b) {
             b.json["images"][0]["bufferView"] =
                 b.add_view(png_of({2, 1, {201, 10, 10, 255, 10, 200, 10, 0}}));
         }},
        {"a texel's alpha",
         [](auto& b) {
             b.json["images"][0]["bufferView"] =
                 b.add_view(png_of({2, 1, {200, 10, 10, 255, 10, 200, 10, 1}}));
         }},
        {"the picture's shape",
         [](auto& b) {
             b.json["images"][0]["bufferView"] =
                 b.add_view(png_of({1, 2, {200, 10, 10, 255, 10, 200, 10, 0}}));
         }},
        {"the wrapping", [](auto& b) { b.json["samplers"][0]["wrapS"] = 10497; }},
        {"the wrapping the other way", [](auto& b) { b.json["samplers"][0]["wrapT"] = 33648; }},
        {"no texture",
         [](auto& b) { b.json["materials"][0]["pbrMetallicRoughness"].erase("baseColorTexture"); }},
        {"another material", [](auto& b) { b.json["meshes"][0]["primitives"][0]["material"] = 1; }},
        {"a place", [](auto& b) { node(b, 1)["translation"][0] = 4.001; }},
        {"a turn",
         [](auto& b) {
             node(b, 1)["rotation"] = {0, 0.6, 0, 0.8};
         }},
        {"a size",
         [](auto& b) {
             node(b, 1)["scale"] = {1, 1, 2};
         }},
        {"a mirror",
         [](auto& b) {
             node(b, 1)["scale"] = {1, 1, -1};
         }},
        {"an instance",
         [](auto& b) {
             b.json["accessors"]
                   [node(b, 2)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"]
                        .template get<std::size_t>()]["count"] = 1;
         }},
        {"a role", [](auto& b) { node(b, 2)["extras"]["bake_role"] = "static"; }},
        {"an object ignored", [](auto& b) { node(b, 1)["extras"]["bake_role"] = "ignore"; }},
        {"an object twice", [](auto& b) { b.add_node({.mesh = 0}); }},
        {"a probe moved", [](auto& b) { node(b, 4)["translation"][0] = 9; }},
        {"a probe more", [](auto& b) { b.add_node({.role = "probe"}); }},
        {"an interior's probe", [](auto& b) { node(b, 5)["extras"]["bake_probe"] = "other"; }},
        {"an interior's probe left open", [](auto& b) { node(b, 5)["extras"].erase("bake_probe"); }},
        {"a volume moved",
         [](auto& b) {
             node(b, 5)["translation"] = {0.5, 0, 0};
         }},
        {"a volume's kind", [](auto& b) { node(b, 6)["extras"]["bake_role"] = "interior"; }},
        {"a light's intensity",
         [](auto& b) { b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 6; }},
        {"a light's colour",
         [](auto& b) {
             b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["color"] = {1, 1, 0.5};
         }},
        {"a light's range",
         [](auto& b) { b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["range"] = 6; }},
        {"a light's cone",
         [](auto& b) {
             b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]["outerConeAngle"] = 0.5;
         }},
        {"a light's inner cone",
         [](auto& b) {
             b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]["innerConeAngle"] = 0.5;
         }},
        {"a light's kind",
         [](auto& b) { b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "point"; }},
        {"a light's place", [](auto& b) { node(b, 7)["translation"][1] = 4; }},
        {"a spot's direction",
         [](auto& b) {
             node(b, 7)["rotation"] = {0, 0.6, 0, 0.8};
         }},
        {"a sun's direction",
         [](auto& b) {
             node(b, 9)["rotation"] = {0, 0.6, 0, 0.8};
         }},
        {"a light less", [](auto& b) { node(b, 7).erase("extensions"); }},
    };
    std::set<Digest> seen = {content_of(village())};
    for (const auto& [name, edit] : edits) {
        SCOPED_TRACE(name);
        GltfBuilder b = village();
        edit(b);
        EXPECT_TRUE(seen.insert(content_of(b)).second) << name << " does not show";
    }
}

// An interior without a named probe uses the nearest one, whatever stands at the origin.
TEST(ContentDigest, ProbeNamedAtTheOriginIsNotTheNearestOne) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(box({4, 0, 0}, {6, 2, 2})), .role = "interior", .probe = "far"});
    b.add_node({.name = "far", .role = "probe"});
    b.add_node({.translation = glm::dvec3(5, 1, 1), .name = "near", .role = "probe"});
    const Digest named = content_of(b);
    node(b, 0)["extras"].erase("bake_probe");
    EXPECT_NE(content_of(b), named);
}

TEST(ContentDigest, DoesNotSeeWhatABakeDoesNot) {
    const std::vector<NamedEdit> edits = {
        {"names",
         [](auto& b) {
             for (Json& n : b.json["nodes"]) {
                 if (n.value("name", "") != "lamp")
                     n["name"] = "renamed";
             }
             b.json["materials"][0]["name"] = "renamed";
             b.json["meshes"][0]["name"] = "renamed";
         }},
        {"a probe and who names it renamed together",
         [](auto& b) {
             node(b, 3)["name"] = "lantern";
             node(b, 5)["extras"]["bake_probe"] = "lantern";
         }},
        {"extras", [](auto& b) { node(b, 0)["extras"]["comment"] = "by the artist"; }},
        {"generator", [](auto& b) { b.json["asset"]["generator"] = "other"; }},
        {"normals",
         [](auto& b) {
             b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
                 b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
         }},
        {"texture coordinates of an untextured mesh",
         [](auto& b) { b.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0"); }},
        {"roughness",
         [](auto& b) { b.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.25; }},
        {"the strength of no emission",
         [](auto& b) {
             b.json["materials"][1]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 9;
         }},
        {"the picture of no emission",
         [](auto& b) {
             b.json["materials"][1]["emissiveTexture"] = {{"index", 0}};
         }},
        {"the colour of no transmission",
         [](auto& b) {
             b.json["materials"][1]["extensions"]["KHR_materials_diffuse_transmission"] = {
                 {"diffuseTransmissionColorFactor", {1, 0.5, 1}}};
         }},
        {"the picture of no transmission",
         [](auto& b) {
             b.json["materials"][1]["extensions"]["KHR_materials_diffuse_transmission"] = {
                 {"diffuseTransmissionTexture", {{"index", 0}}}};
         }},
        {"the cutoff of an opaque material", [](auto& b) { b.json["materials"][1]["alphaCutoff"] = 0.125; }},
        {"alpha of an opaque material",
         [](auto& b) { b.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25; }},
        {"minus zero for a colour",
         [](auto& b) { b.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"][0] = -0.0; }},
        {"a transform of coordinates that changes nothing",
         [](auto& b) {
             b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
                   ["KHR_texture_transform"] = {{"rotation", 0}};
         }},
        {"filters", [](auto& b) { b.json["samplers"][0]["minFilter"] = 9728; }},
        {"unused things",
         [](auto& b) {
             b.add_mesh(ground(77), b.add_material({.colour = {0.125f, 0, 0, 1},
                                                    .texture = b.add_texture({1, 1, {1, 1, 1, 1}})}));
             b.add_node({.name = "empty"});
             b.add_light(Json::parse(R"({"type": "point", "intensity": 9})"));
         }},
        {"an ignored object",
         [](auto& b) { b.add_node({.mesh = 0, .translation = glm::dvec3(50, 0, 0), .role = "ignore"}); }},
        {"an unindexed copy of the vertices",
         [](auto& b) {
             b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
                 b.add_values(ground(20).positions, gltf_f32, "VEC3");
         }},
        {"narrow indices",
         [](auto& b) {
             b.json["meshes"][0]["primitives"][0]["indices"] =
                 b.add_values(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, gltf_u8, "SCALAR");
         }},
        {"vertices in another order",
         [](auto& b) {
             const auto p = ground(20).positions;
             b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
                 b.add_values(std::vector<glm::vec3>{p[3], p[2], p[1], p[0], {9, 9, 9}}, gltf_f32, "VEC3");
             b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
                 b.add_values(std::vector<glm::vec4>(5, glm::vec4(0.5f, 0.5f, 0.25f, 1)), gltf_f32, "VEC4");
             b.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
             b.json["meshes"][0]["primitives"][0]["indices"] =
                 b.add_values(std::vector<std::uint8_t>{3, 2, 1, 3, 1, 0}, gltf_u8, "SCALAR");
         }},
        {"nodes in another order",
         [](auto& b) { std::reverse(b.json["nodes"].begin(), b.json["nodes"].end()); }},
        {"a group around a node",
         [](auto& b) {
             const int group = b.add_node({.children = {1}});
             (void)group;
         }},
        {"a matrix instead of a translation",
         [](auto& b) {
             node(b, 1).erase("translation");
             node(b, 1)["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1};
         }},
        {"a minus zero in a place", [](auto& b) { node(b, 1)["translation"][1] = -0.0; }},
        {"a minus zero in a probe's place", [](auto& b) { node(b, 3)["translation"][2] = -0.0; }},
        {"a minus zero in a volume's place",
         [](auto& b) {
             node(b, 6)["translation"] = {-0.0, -0.0, -0.0};
         }},
        {"instances in another order",
         [](auto& b) {
             node(b, 2)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
                 b.add_values(std::vector<glm::vec3>{{2, 0, 0}, {1, 0, 0}}, gltf_f32, "VEC3");
         }},
        {"lights in another order",
         [](auto& b) {
             Json& lights = b.json["extensions"]["KHR_lights_punctual"]["lights"];
             std::swap(lights[0], lights[1]);
             std::swap(node(b, 7)["extensions"], node(b, 8)["extensions"]);
         }},
        {"the direction of a point light",
         [](auto& b) {
             node(b, 8)["rotation"] = {0, 0.6, 0, 0.8};
         }},
        {"the place of a sun",
         [](auto& b) {
             node(b, 9)["translation"] = {5, 5, 5};
         }},
        {"a mesh that others share",
         [](auto& b) {
             b.json["nodes"][0]["mesh"] = b.json["meshes"].size();
             b.json["meshes"].push_back(Json(b.json["meshes"][0]));
         }},
    };
    const Digest plain = content_of(village());
    for (const auto& [name, edit] : edits) {
        SCOPED_TRACE(name);
        GltfBuilder b = village();
        edit(b);
        EXPECT_EQ(content_of(b), plain) << name << " shows";
    }
}

TEST(ContentDigest, DoesNotSeeHowTheMapIsFiled) {
    const GltfBuilder b = village();
    const Digest plain = content_of(b);
    EXPECT_EQ(expect_accepted(import_files({{"other.glb", b.glb()}}, {"other.glb"})).content, plain);
    EXPECT_EQ(expect_accepted(
                  import_files({{"f/x.gltf", bytes_of(b.gltf("y.bin"))}, {"f/y.bin", b.bin}}, {"f/x.gltf"}))
                  .content,
              plain);

    // Two buffers, views and accessors reversed.
    GltfBuilder r = b;
    const std::size_t views = r.json["bufferViews"].size(), accessors = r.json["accessors"].size();
    std::reverse(r.json["bufferViews"].begin(), r.json["bufferViews"].end());
    std::reverse(r.json["accessors"].begin(), r.json["accessors"].end());
    for (Json& a : r.json["accessors"])
        a["bufferView"] = views - 1 - a["bufferView"].get<std::size_t>();
    for (Json& i : r.json["images"])
        i["bufferView"] = views - 1 - i["bufferView"].get<std::size_t>();
    for (Json& mesh : r.json["meshes"]) {
        for (Json& primitive : mesh["primitives"]) {
            primitive["indices"] = accessors - 1 - primitive["indices"].get<std::size_t>();
            for (Json& attribute : primitive["attributes"])
                attribute = accessors - 1 - attribute.get<std::size_t>();
        }
    }
    Json& trees = node(r, 2)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"];
    trees = accessors - 1 - trees.get<std::size_t>();
    r.json["buffers"] = Json::parse(R"([{"byteLength": 1, "uri": "data:;base64,AAAA"}, {}])");
    r.json["buffers"][1] = {{"byteLength", r.bin.size()}, {"uri", "r.bin"}};
    for (Json& view : r.json["bufferViews"])
        view["buffer"] = 1;
    EXPECT_EQ(
        expect_accepted(import_files({{"r.gltf", bytes_of(r.gltf())}, {"r.bin", r.bin}}, {"r.gltf"})).content,
        plain);
}

TEST(ContentDigest, DoesNotSeeTheOrderOfFiles) {
    GltfBuilder a, b;
    a.place(ground(1), "", a.add_material({.colour = {1, 0, 0, 1}}));
    a.add_node({.light = a.add_light(Json::parse(R"({"type": "point", "intensity": 3})")),
                .translation = glm::dvec3(1, 0, 0)});
    b.place(ground(2), "", b.add_material({.colour = {0, 1, 0, 1}}));
    b.add_node({.light = b.add_light(Json::parse(R"({"type": "point", "intensity": 4})")),
                .translation = glm::dvec3(2, 0, 0)});
    const Files files = {{"a.gltf", bytes_of(a.gltf())}, {"b.gltf", bytes_of(b.gltf())}};
    const Map ab = expect_accepted(import_files(files, {"a.gltf", "b.gltf"})),
              ba = expect_accepted(import_files(files, {"b.gltf", "a.gltf"}));
    EXPECT_EQ(ab.content, ba.content);
    // What a bake adds up must come in the same order too, or the last bits differ.
    ASSERT_EQ(ab.lights.size(), ba.lights.size());
    for (std::size_t n = 0; n < ab.lights.size(); ++n)
        EXPECT_EQ(ab.lights[n].intensity, ba.lights[n].intensity);
    for (std::size_t n = 0; n < ab.objects.size(); ++n)
        EXPECT_EQ(ab.objects[n].digest, ba.objects[n].digest);
}

TEST(ContentDigest, EqualRoomsWithTwoProbesCountInAnyOrder) {
    GltfBuilder b;
    const int room = b.add_mesh(box({0, 0, 0}, {1, 1, 1}));
    for (const char* name : {"one", "two"}) {
        b.add_node({.mesh = room, .role = "interior", .probe = name});
        b.add_node({.translation = glm::dvec3(name[0] == 'o' ? 1 : 2, 0, 0), .name = name, .role = "probe"});
    }
    const Digest plain = content_of(b);
    std::reverse(b.json["nodes"].begin(), b.json["nodes"].end());
    EXPECT_EQ(content_of(b), plain);
}

TEST(ObjectDigest, CoversMeshPlaceAndRoleOnly) {
    const auto digest = [](const NodeSource& source, float size) {
        GltfBuilder b;
        NodeSource placed = source;
        placed.mesh = b.add_mesh(ground(size));
        b.add_node(placed);
        return expect_accepted(b.import()).objects.at(0).digest;
    };
    const Digest plain = digest({.name = "a"}, 1);
    EXPECT_EQ(digest({.name = "b"}, 1), plain);
    EXPECT_NE(digest({.role = "vegetation"}, 1), plain);
    EXPECT_NE(digest({.translation = glm::dvec3(0, 0, 1e-3)}, 1), plain);
    EXPECT_NE(digest({}, 1.5f), plain);
}

TEST(Digest, IsSha256InHex) {
    const FileBytes abc = bytes_of("abc");  // FIPS 180-2, appendix B.1
    EXPECT_EQ(map::to_hex(map::digest_of(abc)),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(map::digest_from_hex(map::to_hex(map::digest_of(abc))), map::digest_of(abc));
    EXPECT_FALSE(map::digest_from_hex("ba78"));
    EXPECT_FALSE(map::digest_from_hex(std::string(64, 'G')));
    EXPECT_FALSE(map::digest_from_hex(std::string(64, 'A')));
    EXPECT_FALSE(map::digest_from_hex(std::string(65, 'a')));
}

}  // namespace
}  // namespace drtv::test
