// Each kind of bad input gets one clear sentence that names the file and the element.
#include "bakerd/map/import.h"
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include <sys/stat.h>
#include <unistd.h>

namespace drtv::test {
namespace {

using map::Map;
using Parts = std::initializer_list<std::string>;

tl::expected<Map, std::string> import_text(const std::string& text) {
    return import_files({{"map.gltf", bytes_of(text)}}, {"map.gltf"});
}

// A textured, indexed ground on node 1, child of node 0; `edit` breaks it.
GltfBuilder sound() {
    GltfBuilder b;
    const int material = b.add_material({.texture = b.add_texture({1, 1, {1, 2, 3, 4}}, {{"wrapS", 33071}})});
    b.add_node({.children = {1}, .name = "root"});
    b.add_node({.mesh = b.add_mesh(ground(1), material), .name = "leaf"});
    return b;
}

void expect_broken(Parts parts, const std::function<void(Json&)>& edit) {
    GltfBuilder b = sound();
    // The builder's own buffer and scene first, so that they can be broken too.
    b.json = Json::parse(b.gltf());
    edit(b.json);
    std::vector<std::string> all(parts);
    SCOPED_TRACE(::testing::PrintToString(all));
    const auto result = import_text(b.json.dump());
    expect_refused(result, {"map.gltf: "});
    for (const std::string& part : all)
        expect_refused(result, {part});
}

TEST(BadInput, SoundFileIsAccepted) {
    EXPECT_EQ(expect_accepted(sound().import()).objects.size(), 1u);
}

TEST(BadInput, FilesThatAreNotGltf) {
    for (const std::string& text :
         {std::string(), std::string(" "), std::string("hello"), std::string("glTF"),
          std::string("\x89PNG\r\n\x1A\n"), std::string("<xml/>"), std::string("[]"), std::string("1"),
          std::string("null"), std::string("{"), std::string("{}"), std::string("{\"asset\"}"),
          std::string("{\"asset\": {\"version\": \"2.0\"}} x"), std::string("\xEF\xBB\xBF{}"),
          std::string(100, '\0'), std::string("{\"a\": \"\xFF\xFE\"}"),
          std::string("{\"asset\": {\"version\": 1e999}}")}) {
        expect_refused(import_text(text), {"map.gltf: "});
    }
}

TEST(BadInput, FilesOfOtherProgramsAreNamed) {
    using namespace std::string_literals;
    const std::vector<std::pair<std::string, std::string>> kinds = {
        {"BLENDER-v300RENDH"s, "Blender"},
        {"\x28\xB5\x2F\xFD\x00"s, "Blender"},
        {"Kaydara FBX Binary  \0\x1A"s, "FBX"},
        {"; FBX 7.3.0 project file"s, "FBX"},
        {"PK\x03\x04\x14"s, "ZIP"},
        {"\x1F\x8B\x08"s, "gzip"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:0"s, "git lfs pull"},
        {"DRTV\x07"s, "sector file"},
        {"\x89PNG\r\n\x1A\n"s, "picture"},
        {"\xFF\xD8\xFF\xE0"s, "picture"},
        {"ply\nformat ascii 1.0\n"s, "PLY"},
        {"solid cube\n"s, "STL"},
        {"# Blender 4.2 MTL File"s, "OBJ"},
        {"#usda 1.0"s, "USD"},
        {"PXR-USDC\0"s, "USD"},
        {"<!DOCTYPE html><html>"s, "web page"},
        {"\xFF\xFE{\0"s, "UTF-16"},
        {"<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">"s, "COLLADA"}};
    for (const auto& [bytes, word] : kinds)
        expect_refused(import_text(bytes), {"map.gltf: it is ", word});
}

TEST(BadInput, ByteOrderMarkIsIgnored) {
    const auto map = import_text("\xEF\xBB\xBF" + sound().gltf());
    EXPECT_EQ(expect_accepted(map).objects.size(), 1u);
}

TEST(BadInput, BrokenJsonIsToldByLineAndColumn) {
    expect_refused(import_text("{\n  \"asset\": {\"version\": \"2.0\"},\n  \"nodes\": [1,]\n}"),
                   {"broken at line 3, column 15"});
    expect_refused(import_text("{\"asset\" {}}"), {"broken at line 1, column 10"});
    expect_refused(import_text("{\"asset\": {\n"), {"ends too early at line 2, column 1"});
    expect_refused(import_text("{\"asset\": 1e999}"), {"out of range"});
}

TEST(BadInput, DeeplyNestedJson) {
    for (const char* open : {"[", "{\"a\":"}) {
        std::string text = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
        for (int n = 0; n < 1000000; ++n)
            text += open;
        expect_refused(import_text(text), {"map.gltf: "});
    }
}

TEST(BadInput, MissingFileIsNamed) {
    expect_refused(import_files({}, {"nowhere/map.gltf"}), {"nowhere/map.gltf"});
    expect_refused(
        map::import_map(std::vector<std::string>{"nowhere.gltf"}, map::folder_source("/nonexistent")),
        {"nowhere.gltf", "No such file"});
}

TEST(BadInput, Versions) {
    expect_broken({"1.0"}, [](Json& j) { j["asset"]["version"] = "1.0"; });
    expect_broken({"3.0"}, [](Json& j) { j["asset"]["version"] = "3.0"; });
    expect_broken({"2.1"}, [](Json& j) { j["asset"]["minVersion"] = "2.1"; });
    expect_broken({"asset", "version"}, [](Json& j) { j["asset"].erase("version"); });
    expect_broken({"asset"}, [](Json& j) { j.erase("asset"); });
    expect_broken({"asset", "version", "2"}, [](Json& j) { j["asset"]["version"] = 2.0; });
}

TEST(BadInput, UnsupportedRequiredExtensionIsNamed) {
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_texture_webp",
                             "KHR_texture_basisu", "MY_own"}) {
        expect_broken({name}, [&](Json& j) { j["extensionsRequired"] = {"KHR_texture_transform", name}; });
    }
    expect_broken({"extensionsRequired"}, [](Json& j) { j["extensionsRequired"] = {1}; });
    expect_broken({"extensionsUsed"}, [](Json& j) { j["extensionsUsed"] = "x"; });
}

TEST(BadInput, Buffers) {
    expect_broken({"buffer 0", "uri"}, [](Json& j) { j["buffers"][0].erase("uri"); });
    expect_broken({"buffer 0", "gone.bin"}, [](Json& j) { j["buffers"][0]["uri"] = "gone.bin"; });
    expect_broken({"buffer 0", "byteLength"}, [](Json& j) { j["buffers"][0].erase("byteLength"); });
    expect_broken({"buffer 0", "byteLength"}, [](Json& j) { j["buffers"][0]["byteLength"] = -1; });
    expect_broken({"buffer 0", "100000"}, [](Json& j) { j["buffers"][0]["byteLength"] = 100000; });
    expect_broken({"buffer 0"},
                  [](Json& j) { j["buffers"][0]["uri"] = "data:application/octet-stream;base64,"; });
    expect_broken({"buffer 0"}, [](Json& j) { j["buffers"][0]["uri"] = "data:text/plain,hello"; });
    expect_broken({"buffer 0"},
                  [](Json& j) { j["buffers"][0]["uri"] = "data:application/octet-stream;base64,####"; });
    expect_broken({"buffer 0", "uri"}, [](Json& j) { j["buffers"][0]["uri"] = 3; });
    // Decodes to bytes that are not UTF-8 (found by fuzzing: the importer threw).
    expect_broken({"buffer 0", "UTF-8"}, [](Json& j) { j["buffers"][0]["uri"] = "%AA"; });
    expect_broken({"buffers"}, [](Json& j) { j["buffers"] = 3; });
    expect_broken({"buffer 0"}, [](Json& j) { j["buffers"][0] = 3; });
    expect_broken({"bufferView 1", "buffer", "7"}, [](Json& j) { j["bufferViews"][1]["buffer"] = 7; });
    expect_broken({"bufferView 1", "byteLength"}, [](Json& j) { j["bufferViews"][1].erase("byteLength"); });
    expect_broken({"bufferView 1", "byteOffset"}, [](Json& j) { j["bufferViews"][1]["byteOffset"] = -4; });
    expect_broken({"bufferView 1", "byteLength"}, [](Json& j) { j["bufferViews"][1]["byteLength"] = 1e300; });
    expect_broken({"bufferView 1", "byteLength"},
                  [](Json& j) { j["bufferViews"][1]["byteLength"] = UINT64_MAX; });
    expect_broken({"bufferView 1", "1000048"}, [](Json& j) {
        j["bufferViews"][1].update({{"byteOffset", 1000000}, {"byteLength", 48}});
    });
    expect_broken({"bufferView 1", "byteStride"}, [](Json& j) { j["bufferViews"][1]["byteStride"] = 13; });
    expect_broken({"bufferView 1", "byteStride"}, [](Json& j) { j["bufferViews"][1]["byteStride"] = 4096; });
}

TEST(BadInput, ExternalBufferThatIsTooShort) {
    GltfBuilder b;
    b.place(ground(1));
    FileBytes shorter = b.bin;
    shorter.pop_back();
    expect_refused(
        import_files({{"map.gltf", bytes_of(b.gltf("x.bin"))}, {"x.bin", shorter}}, {"map.gltf"}),
        {"map.gltf", "buffer 0", "x.bin", std::to_string(shorter.size()), std::to_string(b.bin.size())});
    expect_refused(import_files({{"map.gltf", bytes_of(b.gltf("x.bin"))}, {"x.bin", {}}}, {"map.gltf"}),
                   {"map.gltf", "buffer 0", "x.bin"});
}

TEST(BadInput, GlbBinChunk) {
    GltfBuilder b;
    b.place(ground(1));
    const auto import_glb = [](const FileBytes& glb) {
        return import_files({{"map.glb", glb}}, {"map.glb"});
    };
    expect_refused(import_glb(glb_of(b.document().dump(), {})), {"map.glb", "buffer 0"});
    expect_refused(import_glb(glb_of(b.document().dump(), std::span(b.bin).first(8))),
                   {"map.glb", "buffer 0"});
    FileBytes glb = b.glb();
    glb[4] = 1;
    expect_refused(import_glb(glb), {"map.glb", "version 1"});
    glb[4] = 2;
    glb[16] = 'X';
    expect_refused(import_glb(glb), {"map.glb", "JSON"});
    glb = b.glb();
    glb[8] = static_cast<std::uint8_t>(glb[8] + 4);
    expect_refused(import_glb(glb), {"map.glb", std::to_string(glb.size() + 4)});
    glb = b.glb();
    glb[8] = 12, glb[9] = 0;
    expect_refused(import_glb(glb), {"map.glb", "12"});
    glb = b.glb();
    glb[12] = 255, glb[13] = 255, glb[14] = 255, glb[15] = 255;
    expect_refused(import_glb(glb), {"map.glb"});
    GltfBuilder second = b;
    second.json["buffers"] = Json::parse(R"([{"byteLength": 4, "uri": "data:;base64,AAAAAA=="}, {}])");
    second.json["buffers"][1]["byteLength"] = b.bin.size();
    expect_refused(import_glb(second.glb()), {"map.glb", "buffer 1"});
}

TEST(BadInput, PathsThatLeaveTheFolder) {
    for (const char* uri :
         {"../../secret.bin", "a/../../../secret.bin", "%2e%2e/%2e%2e/secret.bin", "..%2F..%2Fsecret.bin",
          "a/..", "/etc/passwd", "%2Fetc/passwd", "file:///etc/passwd", "http://example.org/x", "C:\\x",
          "C:/x", "..\\x", "a\\..\\..\\x", "a%00b", "", "\\\\host\\share", "data:/../../secret.bin",
          "DATA:/../x", "a/./../../../x"}) {
        std::vector<std::string> asked;
        GltfBuilder b;
        b.place(ground(1));
        b.json = Json::parse(b.gltf());
        for (const char* array : {"buffers", "images"}) {
            Json broken = b.json;
            if (std::string(array) == "images")
                broken["images"] = Json::array({Json::object({{"uri", uri}})});
            else
                broken["buffers"][0]["uri"] = uri;
            const std::string text = broken.dump();
            const auto result =
                map::import_map(std::vector<std::string>{"in/map.gltf"},
                                [&](const std::string& path) -> tl::expected<FileBytes, map::FileFailure> {
                                    if (path == "in/map.gltf")
                                        return bytes_of(text);
                                    asked.push_back(path);
                                    return FileBytes(100);
                                });
            SCOPED_TRACE(std::string(array) + " " + uri);
            expect_refused(result, {"in/map.gltf", std::string(array) == "images" ? "image 0" : "buffer 0"});
            EXPECT_TRUE(asked.empty()) << asked[0];
        }
    }
}

TEST(BadInput, MapPathsThatLeaveTheFolder) {
    for (const char* path : {"../map.gltf", "/etc/passwd", "a/../../map.gltf", ""}) {
        bool asked = false;
        const auto result =
            map::import_map(std::vector<std::string>{path},
                            [&](const std::string&) -> tl::expected<FileBytes, map::FileFailure> {
                                asked = true;
                                return FileBytes{};
                            });
        expect_refused(result, {path});
        EXPECT_FALSE(asked) << path;
    }
}

TEST(BadInput, Accessors) {
    // 0: positions, 1: coordinates, 2: indices; views 1, 2, 3.
    expect_broken({"accessor 0"}, [](Json& j) { j["accessors"][0]["count"] = 5; });
    expect_broken({"accessor 2"}, [](Json& j) { j["accessors"][2]["count"] = 7; });
    expect_broken({"accessor 0", "count"}, [](Json& j) { j["accessors"][0]["count"] = -1; });
    expect_broken({"accessor 0", "count"}, [](Json& j) { j["accessors"][0].erase("count"); });
    expect_broken({"mesh 0", "2147483"}, [](Json& j) { j["accessors"][0]["count"] = 1u << 31; });
    expect_broken({"accessor 0"}, [](Json& j) { j["accessors"][0]["byteOffset"] = 4; });
    expect_broken({"accessor 0"}, [](Json& j) { j["accessors"][0]["byteOffset"] = (1ull << 40) - 1; });
    expect_broken({"accessor 0", "bufferViews", "9"}, [](Json& j) { j["accessors"][0]["bufferView"] = 9; });
    expect_broken({"accessor 0", "bufferView"}, [](Json& j) { j["accessors"][0]["bufferView"] = -1; });
    expect_broken({"accessor 0", "component"}, [](Json& j) { j["accessors"][0]["componentType"] = 5124; });
    expect_broken({"accessor 0", "component"}, [](Json& j) { j["accessors"][0]["componentType"] = 5130; });
    expect_broken({"accessor 0", "component"}, [](Json& j) { j["accessors"][0]["componentType"] = 7; });
    expect_broken({"accessor 0", "VEC5"}, [](Json& j) { j["accessors"][0]["type"] = "VEC5"; });
    expect_broken({"accessor 0"}, [](Json& j) { j["accessors"][0]["type"] = "VEC2"; });
    expect_broken({"accessor 0"}, [](Json& j) { j["accessors"][0]["type"] = "MAT4"; });
    expect_broken({"accessor 2", "5126"}, [](Json& j) { j["accessors"][2]["componentType"] = gltf_f32; });
    expect_broken({"accessor 2", "5122"}, [](Json& j) { j["accessors"][2]["componentType"] = gltf_i16; });
    expect_broken({"accessor 2"}, [](Json& j) { j["accessors"][2].erase("bufferView"); });
    expect_broken({"accessor 0", "stride"}, [](Json& j) { j["bufferViews"][1]["byteStride"] = 8; });
    expect_broken({"accessor 0", "normalized"}, [](Json& j) { j["accessors"][0]["normalized"] = 1; });
}

TEST(BadInput, SparseAccessors) {
    const auto broken = [](Parts parts, const std::function<void(Json&)>& edit) {
        expect_broken(parts, [&](Json& j) {
            Json& sparse = j["accessors"][0]["sparse"];
            // Positions replaced by themselves; the indices' view holds 0, 1, 2, 0, 2, 3.
            sparse = {{"count", 2},
                      {"indices", {{"bufferView", 3}, {"componentType", gltf_u32}}},
                      {"values", {{"bufferView", 1}}}};
            edit(sparse);
        });
    };
    broken({"accessor 0", "5"}, [](Json& s) { s["count"] = 5; });
    broken({"accessor 0", "count"}, [](Json& s) { s["count"] = 4294967297; });
    broken({"accessor 0", "count"}, [](Json& s) { s.erase("count"); });
    broken({"accessor 0", "indices"}, [](Json& s) { s.erase("indices"); });
    broken({"accessor 0", "values"}, [](Json& s) { s.erase("values"); });
    broken({"accessor 0", "bufferViews", "9"}, [](Json& s) { s["indices"]["bufferView"] = 9; });
    broken({"accessor 0", "bufferViews", "9"}, [](Json& s) { s["values"]["bufferView"] = 9; });
    broken({"accessor 0"}, [](Json& s) { s["indices"]["byteOffset"] = 20; });
    broken({"accessor 0", "byteOffset"}, [](Json& s) { s["indices"]["byteOffset"] = 4294967296; });
    broken({"accessor 0", "byteOffset"}, [](Json& s) { s["values"]["byteOffset"] = -4; });
    broken({"accessor 0"}, [](Json& s) { s["values"]["byteOffset"] = 48; });
    broken({"accessor 0", "5126"}, [](Json& s) { s["indices"]["componentType"] = gltf_f32; });
    // Halves of 0, 1, 2 read from 2 on: 0, 65536 and more.
    broken({"accessor 0", "past the 4 elements"}, [](Json& s) { s["indices"]["byteOffset"] = 2; });
    broken({"accessor 0"}, [](Json& s) { s = 3; });
}

TEST(BadInput, CompressionThatIsUsedWithoutBeingRequired) {
    expect_broken({"mesh 0, primitive 0", "KHR_draco_mesh_compression"}, [](Json& j) {
        j["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
            {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
        j["accessors"][0].erase("bufferView");
    });
}

TEST(BadInput, IndexPastTheEnd) {
    for (const std::uint32_t index : {4u, 255u, 0xFFFFFFFFu}) {
        GltfBuilder b;
        Shape shape = ground(1);
        shape.indices[4] = index;
        b.place(shape);
        expect_refused(b.import(), {"map.gltf", "mesh 0, primitive 0", std::to_string(index), "4 vertices"});
    }
}

TEST(BadInput, NotANumber) {
    for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                      -std::numeric_limits<float>::infinity()}) {
        GltfBuilder positions, uvs, colours, instances;
        Shape shape = ground(1);
        shape.colours.assign(4, glm::vec4(1));
        const int textured = uvs.add_material({.texture = uvs.add_texture({1, 1, {1, 2, 3, 4}})});
        shape.positions[2].y = bad;
        positions.place(shape);
        expect_refused(positions.import(), {"map.gltf", "accessor 0", "element 2"});
        shape = ground(1);
        shape.uvs[3].x = bad;
        uvs.place(shape, "", textured);
        expect_refused(uvs.import(), {"map.gltf", "accessor 1", "element 3"});
        shape = ground(1);
        shape.colours.assign(4, glm::vec4(bad));
        colours.place(shape);
        expect_refused(colours.import(), {"map.gltf", "accessor 2", "element 0"});
        instances.add_instances(instances.add_mesh(ground(1)), {{0, 0, 0}, {0, bad, 0}});
        expect_refused(instances.import(), {"map.gltf", "accessor 3", "element 1"});
    }
}

TEST(BadInput, Meshes) {
    expect_broken({"mesh 0", "primitives"}, [](Json& j) { j["meshes"][0]["primitives"] = Json::object(); });
    expect_broken({"mesh 0", "primitives"}, [](Json& j) { j["meshes"][0].erase("primitives"); });
    expect_broken({"mesh 0, primitive 0", "attributes"},
                  [](Json& j) { j["meshes"][0]["primitives"][0].erase("attributes"); });
    expect_broken({"mesh 0, primitive 0", "POSITION", "99"},
                  [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99; });
    expect_broken({"mesh 0, primitive 0", "NORMAL", "-1"},
                  [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = -1; });
    expect_broken({"mesh 0, primitive 0", "indices", "99"},
                  [](Json& j) { j["meshes"][0]["primitives"][0]["indices"] = 99; });
    expect_broken({"mesh 0, primitive 0", "material", "9"},
                  [](Json& j) { j["meshes"][0]["primitives"][0]["material"] = 9; });
    expect_broken({"mesh 0, primitive 0", "mode 7"},
                  [](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 7; });
    expect_broken({"mesh 0, primitive 0", "TEXCOORD_0", "3", "4"},
                  [](Json& j) { j["accessors"][1]["count"] = 3; });
    expect_broken({"meshes"}, [](Json& j) { j["meshes"] = "x"; });
    expect_broken({"mesh 0"}, [](Json& j) { j["meshes"][0] = Json::array(); });
}

TEST(BadInput, MaterialsAndTextures) {
    expect_broken({"material 0", "baseColorFactor"}, [](Json& j) {
        j["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1};
    });
    expect_broken({"material 0", "baseColorFactor", "2"}, [](Json& j) {
        j["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 2, 1};
    });
    expect_broken({"material 0", "baseColorFactor"}, [](Json& j) {
        j["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, -1, 1};
    });
    expect_broken({"material 0", "textures", "9"}, [](Json& j) {
        j["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 9;
    });
    expect_broken({"material 0", "index"}, [](Json& j) {
        j["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].erase("index");
    });
    expect_broken({"material 0", "FOG"}, [](Json& j) { j["materials"][0]["alphaMode"] = "FOG"; });
    expect_broken({"material 0", "alphaCutoff"}, [](Json& j) {
        j["materials"][0].update({{"alphaMode", "MASK"}, {"alphaCutoff", "x"}});
    });
    expect_broken({"material 0", "doubleSided"}, [](Json& j) { j["materials"][0]["doubleSided"] = 1; });
    for (const char* transform :
         {R"({"offset": [1]})", R"({"scale": ["a", 1]})", R"({"rotation": "x"})", R"({"offset": [1e39, 0]})",
          R"({"scale": [1, 1e300]})", R"({"offset": 3})"}) {
        expect_broken({"material 0", "KHR_texture_transform"}, [&](Json& j) {
            j["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
             ["KHR_texture_transform"] = Json::parse(transform);
        });
    }
    expect_broken({"material 0", "texCoord"}, [](Json& j) {
        j["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"]
         ["texCoord"] = 1e300;
    });
    expect_broken({"texture 0", "images", "9"}, [](Json& j) { j["textures"][0]["source"] = 9; });
    expect_broken({"texture 0", "samplers", "9"}, [](Json& j) { j["textures"][0]["sampler"] = 9; });
    expect_broken({"texture 0"}, [](Json& j) { j["textures"][0].erase("source"); });
    expect_broken({"image 0"}, [](Json& j) { j["images"][0] = Json::object(); });
    expect_broken({"image 0"}, [](Json& j) { j["images"][0]["uri"] = "x.png"; });
    expect_broken({"image 0", "gone.png"}, [](Json& j) { j["images"][0] = {{"uri", "gone.png"}}; });
    expect_broken({"image 0", "PNG"}, [](Json& j) { j["images"][0]["bufferView"] = 1; });
    expect_broken({"image 0"}, [](Json& j) { j["images"][0] = {{"uri", "data:image/png;base64,"}}; });
    expect_broken({"image 0", "PNG"}, [](Json& j) {
        j["images"][0] = {{"uri", "data:image/webp;base64,UklGRg=="}};
    });
    expect_broken({"image 0"}, [](Json& j) {
        j["images"][0] = {{"uri", "data:text/plain," + std::string(5000, 'x')}};
    });
}

TEST(BadInput, ImageThatLeavesItsBuffer) {
    expect_broken({"bufferView 0"}, [](Json& j) { j["bufferViews"][0]["byteLength"] = 1000000; });
    expect_broken({"bufferView 0"}, [](Json& j) { j["bufferViews"][0]["byteOffset"] = 100000000; });
    expect_broken({"bufferView 0"}, [](Json& j) { j["bufferViews"][0]["byteLength"] = (1ull << 40) - 1; });
    expect_broken({"image 0"}, [](Json& j) { j["bufferViews"][0]["byteLength"] = 0; });
}

TEST(BadInput, BrokenPictures) {
    const FileBytes png = png_of({4, 4, std::vector<std::uint8_t>(64, 7)});
    const auto import_picture = [](const FileBytes& bytes) {
        GltfBuilder b;
        b.json["images"] = Json::array({Json::object({{"uri", "x.png"}})});
        b.json["textures"] = Json::array({Json::object({{"source", 0}})});
        b.place(ground(1), "", b.add_material({.texture = 0}));
        return import_files({{"map.gltf", bytes_of(b.gltf())}, {"x.png", bytes}}, {"map.gltf"});
    };
    expect_accepted(import_picture(png));
    FileBytes empty_chunk = png;
    const std::string chunk("\0\0\0\0IDAT\x35\xAF\x06\x1E", 12);
    empty_chunk.insert(empty_chunk.begin() + 33, chunk.begin(), chunk.end());
    expect_accepted(import_picture(empty_chunk));
    for (std::size_t size = 0; size + 12 + 16 < png.size(); ++size)
        expect_refused(import_picture({png.begin(), png.begin() + static_cast<std::ptrdiff_t>(size)}),
                       {"map.gltf", "image 0", "x.png"});
    FileBytes huge = png;  // says 16777220 x 16777220 pixels
    huge[16] = huge[20] = 1;
    expect_refused(import_picture(huge), {"map.gltf", "image 0", "x.png"});
    huge[16] = huge[20] = 0;
    huge[18] = huge[22] = 0x40;  // 16388 x 16388
    expect_refused(import_picture(huge), {"map.gltf", "image 0", "x.png"});
}

TEST(BadInput, Nodes) {
    expect_broken({"node 1", "meshes", "9"}, [](Json& j) { j["nodes"][1]["mesh"] = 9; });
    expect_broken({"node 0", "nodes", "9"}, [](Json& j) { j["nodes"][0]["children"] = {9}; });
    expect_broken({"node 0", "children"}, [](Json& j) { j["nodes"][0]["children"] = {-1}; });
    expect_broken({"node 0", "children"}, [](Json& j) { j["nodes"][0]["children"] = {0.5}; });
    expect_broken({"node 0"}, [](Json& j) { j["nodes"][0] = 7; });
    expect_broken({"node 1", "name"}, [](Json& j) { j["nodes"][1]["name"] = 7; });
    expect_broken({"node 1", "matrix"}, [](Json& j) { j["nodes"][1]["matrix"] = {1, 2}; });
    expect_broken({"node 1", "affine"}, [](Json& j) {
        j["nodes"][1]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    });
    expect_broken({"node 1", "affine"}, [](Json& j) {
        j["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    });
    expect_broken({"node 1", "matrix"}, [](Json& j) {
        j["nodes"][1].update(
            {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}, {"scale", {1, 1, 1}}});
    });
    expect_broken({"node 1", "translation"}, [](Json& j) { j["nodes"][1]["translation"] = {1, 2}; });
    expect_broken({"node 1", "translation"}, [](Json& j) { j["nodes"][1]["translation"] = {1, 2, "3"}; });
    expect_broken({"node 1", "translation"}, [](Json& j) { j["nodes"][1]["translation"] = {1, 2, nullptr}; });
    expect_broken({"node 1", "rotation"}, [](Json& j) { j["nodes"][1]["rotation"] = {0, 0, 0, 0}; });
    expect_broken({"node 1", "rotation"}, [](Json& j) { j["nodes"][1]["rotation"] = {0, 1e200, 0, 1e200}; });
    expect_broken({"node 1", "not finite"}, [](Json& j) { j["nodes"][1]["scale"] = {1e300, 1, 1}; });
    expect_broken({"node 1", "10^9"}, [](Json& j) { j["nodes"][1]["scale"] = {1e10, 1, 1}; });
    expect_broken({"node 1", "10^9"}, [](Json& j) { j["nodes"][1]["translation"] = {0, 1e10, 0}; });
    expect_broken({"nodes"}, [](Json& j) { j["nodes"] = 7; });
}

TEST(BadInput, VerticesThatOverflowInTheWorld) {
    // 3e38 * 2 - 3e38 * 2 is NaN in float, and the bounds of the other corners are fine.
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(triangle({3e38f, 3e38f, 0}, {1, 0, 0}, {0, 1, 0})),
                .matrix = {2, 2, 0, 0, -2, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}});
    expect_refused(b.import(), {"map.gltf", "node 0"});
    GltfBuilder flat;
    flat.add_node({.mesh = flat.add_mesh(triangle({3e38f, 3e38f, 0}, {1, 0, 0}, {0, 1, 0})),
                   .matrix = {2, 0, 0, 0, -2, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}});
    expect_refused(flat.import(), {"map.gltf", "node 0"});
}

TEST(BadInput, ProbesVolumesAndLightsFarAway) {
    for (const char* role : {"probe", "no_probes", "interior"}) {
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(ground(1)), .translation = glm::dvec3(1e20, 0, 0), .role = role});
        expect_refused(b.import(), {"map.gltf", "node 0", "10^9"});
    }
    // A probe beyond the last sector that has a number: it would have wrapped around into another (found by a
    // review).
    GltfBuilder beyond;
    beyond.add_node({.translation = glm::dvec3(4'194'314, 1, -10), .role = "probe"});
    expect_refused(beyond.import(), {"map.gltf", "node 0", "4194314 m from the origin"});
    GltfBuilder b;
    b.add_node(
        {.light = b.add_light(Json::parse(R"({"type": "point"})")), .translation = glm::dvec3(1e20, 0, 0)});
    expect_refused(b.import(), {"map.gltf", "node 0", "10^9"});
}

TEST(BadInput, CyclicNodes) {
    expect_broken({"node", "ancestor"}, [](Json& j) {
        j["nodes"] = Json::parse(R"([{"children": [0]}])");
        j["scenes"] = Json::array();
        j.erase("scene");
    });
    expect_broken({"node", "ancestor"}, [](Json& j) {
        j["nodes"] = Json::parse(R"([{"children": [1]}, {"children": [2]}, {"children": [0]}])");
    });
    expect_broken({"node 1", "parents"}, [](Json& j) { j["nodes"][0]["children"] = {1, 1}; });
    expect_broken({"node 1", "parents"}, [](Json& j) { j["nodes"].push_back({{"children", {1}}}); });
}

TEST(BadInput, Scenes) {
    expect_broken({"scene", "5"}, [](Json& j) { j["scene"] = 5; });
    expect_broken({"scene 0", "nodes", "9"}, [](Json& j) { j["scenes"][0]["nodes"] = {9}; });
    expect_broken({"scene 0", "node 1"}, [](Json& j) {
        j["scenes"][0]["nodes"] = {0, 1};
    });  // 1 is 0's child, and would stand there twice
    expect_broken({"scene 0", "node 0"}, [](Json& j) { j["scenes"][0]["nodes"] = {0, 0}; });
    expect_broken({"scene 0", "name"}, [](Json& j) { j["scenes"][0]["name"] = 42; });
}

TEST(BadInput, Instancing) {
    const auto broken = [](Parts parts, const char* attributes) {
        SCOPED_TRACE(attributes);
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(ground(1)), .name = "trees"});
        b.add_values(std::vector<glm::vec3>(2), gltf_f32, "VEC3");  // accessor 3
        b.add_values(std::vector<glm::vec4>(3), gltf_f32, "VEC4");  // accessor 4
        b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = Json::parse(attributes);
        const auto result = b.import();
        for (const std::string& part : parts)
            expect_refused(result, {"map.gltf", part});
    };
    broken({"node 0", "attributes"}, "{}");
    broken({"node 0", "trees", "none of TRANSLATION"}, R"({"attributes": {}})");
    broken({"node 0"}, R"({"attributes": 3})");
    broken({"node 0", "TRANSLATION", "99"}, R"({"attributes": {"TRANSLATION": 99}})");
    broken({"node 0", "TRANSLATION"}, R"({"attributes": {"TRANSLATION": 4294967299}})");
    broken({"node 0", "TRANSLATION"}, R"({"attributes": {"TRANSLATION": "3"}})");
    broken({"accessor 4"}, R"({"attributes": {"TRANSLATION": 4}})");
    broken({"node 0", "2", "3"}, R"({"attributes": {"TRANSLATION": 3, "ROTATION": 4}})");
    broken({"node 0", "rotation"}, R"({"attributes": {"ROTATION": 4}})");
}

// Sentences stay one line, whatever the names in the file.
TEST(BadInput, NamesCannotBreakTheSentence) {
    GltfBuilder b;
    b.add_node({.name = "two\nlines\x1B[31m" + std::string(100000, 'x'), .role = "nothing"});
    expect_refused(b.import(), {"map.gltf", "node 0"});
    GltfBuilder c;
    c.add_node({.role = "line\nbreak" + std::string(100000, 'x')});
    expect_refused(c.import(), {"map.gltf", "node 0"});
}

TEST(BadInput, SecondFileIsNamed) {
    const GltfBuilder b = sound();
    expect_refused(import_files({{"good.gltf", bytes_of(b.gltf())}, {"bad.gltf", bytes_of("{}")}},
                                {"good.gltf", "bad.gltf"}),
                   {"bad.gltf: "});
}

// Small files that ask for much work: refused or done, but soon and in bounded memory.
TEST(Hostile, AccessorWithoutViewCannotBeHuge) {
    GltfBuilder positions, instances;
    positions.place(ground(1));
    positions.json["accessors"][0] = {{"componentType", gltf_f32}, {"type", "VEC3"}, {"count", 100000000}};
    positions.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    expect_refused(positions.import(), {"map.gltf", "accessor 0", "100000000"});
    instances.add_instances(instances.add_mesh(ground(1)), {{0, 0, 0}});
    instances.json["accessors"].back() = {
        {"componentType", gltf_f32}, {"type", "VEC3"}, {"count", 100000000}};
    expect_refused(instances.import(), {"map.gltf", "accessor 3", "100000000"});
}

TEST(Hostile, PrimitivesThatShareABigAccessorAreLimited) {
    GltfBuilder b;
    Shape big;
    big.positions.assign(300000, glm::vec3(1));
    b.place(big);
    const Json primitive = b.json["meshes"][0]["primitives"][0];
    for (int n = 0; n < 30000; ++n)
        b.json["meshes"][0]["primitives"].push_back(primitive);
    expect_refused(b.import(), {"map.gltf", "limit"});
}

TEST(Hostile, InstancesOfABigMeshAreLimited) {
    GltfBuilder b;
    Shape big;
    for (int n = 0; n < 300000; ++n)
        big.positions.emplace_back(n, n % 7, n % 3);
    b.add_instances(b.add_mesh(big), std::vector<glm::vec3>(300000));
    expect_refused(b.import(), {"map.gltf", "node 0", "limit"});
}

TEST(Hostile, VolumesOfABigMeshAreLimited) {
    GltfBuilder b;
    Shape big;
    for (int n = 0; n < 300000; ++n)
        big.positions.emplace_back(n, n % 7, n % 3);
    b.add_instances(b.add_mesh(big), std::vector<glm::vec3>(1000), {.role = "no_probes"});
    expect_refused(b.import(), {"map.gltf", "node 0", "limit"});
}

TEST(Hostile, RootsThatAreOneChainAreRefused) {
    // Walked from each root, n nodes are n * n / 2.
    Json nodes = Json::array(), roots = Json::array();
    for (int n = 0; n < 100000; ++n) {
        nodes.push_back(n + 1 < 100000 ? Json{{"children", Json::array({n + 1})}} : Json::object());
        roots.push_back(n);
    }
    GltfBuilder b;
    b.json["nodes"] = std::move(nodes);
    b.json["scenes"] = Json::array({Json::object({{"nodes", std::move(roots)}})});
    expect_refused(b.import(), {"map.gltf", "scene 0", "node 1"});
}

class FolderSource : public ::testing::Test {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_ / "sub"); }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    const std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("drtv_map_test_" + std::to_string(getpid()));
};

tl::expected<FileBytes, std::string> read(const map::FileSource& source, const std::string& path) {
    return source(path).map_error([](const map::FileFailure& failure) { return failure.sentence; });
}

TEST_F(FolderSource, GivesTheBytes) {
    std::ofstream(folder_ / "sub/x.bin", std::ios::binary) << std::string("a\0b", 3);
    std::ofstream(folder_ / "empty.bin");
    const auto source = map::folder_source(folder_.string());
    EXPECT_EQ(expect_accepted(read(source, "sub/x.bin")), (FileBytes{'a', 0, 'b'}));
    EXPECT_TRUE(expect_accepted(read(source, "empty.bin")).empty());
}

TEST_F(FolderSource, RefusesWhatIsNoFile) {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    const auto source = map::folder_source(folder_.string());
    errno = ENOENT;  // an old error must not show
    expect_refused(read(source, "sub"), {"sub", "file"});
    expect_refused(read(source, "pipe"), {"pipe", "file"});
    expect_refused(read(source, "gone"), {"gone", "No such file"});
    EXPECT_TRUE(source("gone").error().is_missing);
    EXPECT_FALSE(source("pipe").error().is_missing);
}

TEST_F(FolderSource, RefusesFilesTooLargeToHold) {
    std::ofstream(folder_ / "huge").put('x');
    std::filesystem::resize_file(folder_ / "huge", std::uintmax_t{1} << 36);  // sparse: takes no room
    expect_refused(read(map::folder_source(folder_.string()), "huge"), {"huge", "limit"});
}

}  // namespace
}  // namespace drtv::test
