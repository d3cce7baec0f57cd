// Files by others: shared/data/E_importer with what the Khronos validator says of each, and the real maps.
#include "bakerd/map/import.h"
#include "bakerd/map/texture.h"
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

namespace drtv::test {
namespace {

namespace fs = std::filesystem;
using map::Map;

const fs::path data = DRTV_SHARED_DATA, corpus = data / "E_importer";

tl::expected<Map, std::string> import_path(const fs::path& path) {
    return map::import_map(std::vector<std::string>{path.filename().string()},
                           map::folder_source(path.parent_path().string()));
}

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

std::vector<fs::path> gltf_files_under(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
            files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

// One line of the manifest, its fields without quotes.
std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (char c : line) {
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            fields.emplace_back();
        else if (c != '\r')
            fields.back() += c;
    }
    return fields;
}

struct Entry {
    std::string file;
    std::size_t triangles = 0;
};

// The manifest's files under `folder`.
std::vector<Entry> entries_of(const std::string& folder) {
    std::vector<Entry> entries;
    std::ifstream manifest(corpus / "manifest.csv");
    for (std::string line; std::getline(manifest, line);) {
        const auto fields = fields_of(line);
        if (fields.size() > 7 && fields[0].starts_with(folder + "/"))
            entries.push_back({fields[0], fields[7].empty() ? 0 : std::stoul(fields[7])});
    }
    return entries;
}

// The JSON of a .gltf or .glb that is sound enough to have one; else null.
Json json_of(const fs::path& path) {
    std::string text = text_of(path);
    if (text.starts_with("glTF")) {
        if (text.size() < 20)
            return nullptr;
        std::uint32_t size = 0;
        std::memcpy(&size, &text[12], 4);
        text = text.substr(20, size);
    }
    Json json = Json::parse(text, nullptr, false);
    return json.is_object() ? json : Json();
}

std::size_t drawn_triangles(const Map& map) {
    std::size_t triangles = 0;
    for (const map::Object& object : map.objects) {
        for (const map::Primitive& primitive : map.meshes.at(object.mesh).primitives)
            triangles += primitive.triangles.size();
    }
    return triangles;
}

// What all later code relies on.
void expect_sound(const Map& map) {
    const auto finite = [](const glm::vec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    for (const map::Mesh& mesh : map.meshes) {
        for (const map::Primitive& primitive : mesh.primitives) {
            EXPECT_LT(primitive.material, map.materials.size());
            EXPECT_FALSE(primitive.triangles.empty());
            for (const glm::uvec3& t : primitive.triangles)
                ASSERT_TRUE(t.x < primitive.positions.size() && t.y < primitive.positions.size() &&
                            t.z < primitive.positions.size());
            for (const glm::vec3& p : primitive.positions)
                ASSERT_TRUE(finite(p));
            if (!primitive.colours.empty()) {
                EXPECT_EQ(primitive.colours.size(), primitive.positions.size());
            }
            if (map.materials.at(primitive.material).base_texture.present()) {
                EXPECT_EQ(primitive.uvs.size(), primitive.positions.size());
            }
        }
    }
    for (const map::Material& material : map.materials) {
        if (material.base_texture.present()) {
            EXPECT_LT(material.base_texture.texture, map.textures.size());
        }
    }
    for (const map::Texture& texture : map.textures)
        EXPECT_EQ(texture.rgba.size(), std::size_t{texture.width} * texture.height * 4);
    for (const map::Object& object : map.objects) {
        EXPECT_LT(object.mesh, map.meshes.size());
        EXPECT_TRUE(finite(object.bounds.low) && finite(object.bounds.high) && !object.bounds.empty());
    }
}

// A map or one sentence, within two seconds.
tl::expected<Map, std::string> import_quickly(const fs::path& path) {
    const auto start = std::chrono::steady_clock::now();
    auto map = import_path(path);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
    if (map)
        expect_sound(*map);
    else
        expect_refused(map, {path.filename().string()});
    return map;
}

class Corpus : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!fs::exists(corpus / "manifest.csv"))
            GTEST_SKIP() << "no " << corpus;
    }
};

TEST_F(Corpus, ValidFilesAreImported) {
    const std::set<std::string> unsupported = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"};
    for (const Entry& entry : entries_of("valid")) {
        SCOPED_TRACE(entry.file);
        const auto map = import_quickly(corpus / entry.file);
        std::string compressed;
        for (const Json& name : json_of(corpus / entry.file).value("extensionsUsed", Json::array())) {
            if (unsupported.contains(name.get<std::string>()))
                compressed = name.get<std::string>();
        }
        if (!compressed.empty()) {
            expect_refused(map, {compressed});
            continue;
        }
        ASSERT_TRUE(map.has_value()) << map.error();
        // Degenerate triangles are left out.
        EXPECT_LE(drawn_triangles(*map), entry.triangles);
        EXPECT_EQ(drawn_triangles(*map) > 0, entry.triangles > 0);
        if (entry.file.find("Strip") == std::string::npos) {
            EXPECT_EQ(drawn_triangles(*map), entry.triangles);
        }
    }
}

TEST_F(Corpus, OddFilesAreMapOrSentence) {
    for (const Entry& entry : entries_of("odd")) {
        SCOPED_TRACE(entry.file);
        import_quickly(corpus / entry.file);
    }
}

TEST_F(Corpus, InvalidFilesAreRefusedWithTheElement) {
    // What is wrong in each.
    const std::map<std::string, std::vector<std::string>> expected = {
        {"invalid/assimp_BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", {"accessor 2", "inf"}},
        {"invalid/assimp_IncorrectVertexArrays/Cube.gltf", {"bufferView 2", "936", "514"}},
        {"invalid/assimp_IndexOutOfRange/AllIndicesOutOfRange.gltf", {"mesh 0, primitive 0", "65535", "24"}},
        {"invalid/assimp_IndexOutOfRange/IndexOutOfRange.gltf", {"mesh 0, primitive 0", "255", "24"}},
        {"invalid/assimp_RecursiveNodes/RecursiveNodes.gltf", {"node 0", "cycle"}},
        {"invalid/assimp_wrongTypes/badArray.gltf", {"mesh 0", "primitives"}},
        {"invalid/assimp_wrongTypes/badString.gltf", {"scene 0", "name", "42"}},
        {"invalid/cesium_native/cubeSomeBadIndices.glb", {"mesh 0, primitive 0", "15", "8"}},
        {"invalid/gltf_1_0/box.gltf", {"1.0"}},
        {"invalid/tinygltf_bounds/integer-out-of-bounds.gltf", {"bufferView 0", "byteLength"}},
        {"invalid/tinygltf_bounds/invalid-buffer-index.gltf", {"bufferView 1", "buffer"}},
        {"invalid/tinygltf_bounds/invalid-buffer-view-index.gltf", {"bufferView 0", "buffer"}},
        {"invalid/tinygltf_bounds/invalid-primitive-indices.gltf", {"bufferView 0", "buffer"}},
    };
    const auto entries = entries_of("invalid");
    EXPECT_EQ(entries.size(), expected.size());
    for (const Entry& entry : entries) {
        SCOPED_TRACE(entry.file);
        const auto map = import_quickly(corpus / entry.file);
        ASSERT_TRUE(expected.contains(entry.file));
        for (const std::string& part : expected.at(entry.file))
            expect_refused(map, {part});
    }
}

// Whether the validator's error is one that a baker must not swallow. All others lie in what no bake reads
// (animations, cameras, morph targets, normals, tangents, other textures, min and max, extensions),
// say nothing about meaning (alignment, names of attributes, buffer targets, empty arrays, declarations of
// extensions), or are read as they are plainly meant (colours beyond 1 are clamped, positions quantised
// without saying so, media types that the bytes themselves show better).
bool must_refuse(const std::string& code, const std::string& pointer) {
    static const std::set<std::string> grave = {
        // Bytes that are not there, or are less than said.
        "ACCESSOR_INDEX_OOB", "ACCESSOR_SMALL_BYTESTRIDE", "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE",
        "ACCESSOR_TOO_LONG", "BUFFER_BYTE_LENGTH_MISMATCH", "BUFFER_VIEW_TOO_LONG", "IO_ERROR",
        "VALUE_MULTIPLE_OF", "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
        // Files that are not glTF 2.0, or are cut.
        "GLB_DUPLICATE_CHUNK", "GLB_INVALID_VERSION", "GLB_LENGTH_MISMATCH", "GLB_LENGTH_TOO_SMALL",
        "GLB_UNEXPECTED_END_OF_CHUNK_HEADER", "GLB_UNEXPECTED_END_OF_HEADER", "GLB_UNEXPECTED_FIRST_CHUNK",
        "INVALID_JSON", "INVALID_URI", "PATTERN_MISMATCH", "UNKNOWN_ASSET_MAJOR_VERSION", "TYPE_MISMATCH",
        "UNDEFINED_PROPERTY", "UNRESOLVED_REFERENCE", "ONE_OF_MISMATCH", "VALUE_NOT_IN_RANGE",
        // Nodes that stand in no clear place.
        "NODE_LOOP", "NODE_MATRIX_TRS", "NODE_PARENT_OVERRIDE", "SCENE_NON_ROOT_NODE"};
    if (!grave.contains(code))
        return false;
    for (const char* unread : {"/animations", "/cameras", "/targets", "/normalTexture", "/emissiveTexture",
                               "/occlusionTexture", "/extensions/KHR_materials", "/extensions/KHR_invalid"}) {
        if (pointer.find(unread) != std::string::npos)
            return false;
    }
    // An image's data uri with a strange media type: the bytes decide, when a material wants it.
    return !(code == "INVALID_URI" && pointer.starts_with("/images"));
}

TEST_F(Corpus, ValidatorFilesWithGraveErrorsPlaceNothing) {
    std::size_t grave = 0;
    for (const Entry& entry : entries_of("khronos_validator")) {
        SCOPED_TRACE(entry.file);
        const fs::path path = corpus / entry.file;
        const auto map = import_quickly(path);
        const Json report = Json::parse(text_of(path.string() + ".report.json"), nullptr, false);
        if (!report.is_object())
            continue;
        std::string reason;
        for (const Json& message : report["issues"]["messages"]) {
            if (message["severity"] == 0 && must_refuse(message["code"], message.value("pointer", "")))
                reason = message.dump();
        }
        if (reason.empty())
            continue;
        ++grave;
        EXPECT_TRUE(!map || map->objects.empty()) << reason;
    }
    EXPECT_GT(grave, 40u);
}

// Most of the validator's files place none of their meshes; here each gets a node.
TEST_F(Corpus, ValidatorMeshesPlacedAreMapOrSentence) {
    for (const Entry& entry : entries_of("khronos_validator")) {
        SCOPED_TRACE(entry.file);
        const fs::path path = corpus / entry.file;
        Json json = json_of(path);
        if (!json.contains("meshes") || !json["meshes"].is_array())
            continue;
        for (std::size_t n = 0; n < json["meshes"].size(); ++n)
            json["nodes"].push_back({{"mesh", n}});
        json.erase("scene");
        json.erase("scenes");
        const auto folder = map::folder_source(path.parent_path().string());
        const auto map =
            map::import_map(std::vector<std::string>{"placed.gltf"}, [&](const std::string& wanted) {
                return wanted == "placed.gltf"
                           ? tl::expected<FileBytes, map::FileFailure>(bytes_of(json.dump()))
                           : folder(wanted);
            });
        if (map)
            expect_sound(*map);
        else
            expect_refused(map, {"placed.gltf"});
        for (const char* broken : {"index_buffer_oob", "accessor_unequal_count", "unresolved_indices",
                                   "small_stride", "joints_no_weights"}) {
            if (entry.file.find(broken) != std::string::npos) {
                EXPECT_TRUE(!map || map->objects.empty());
            }
        }
    }
}

TEST_F(Corpus, RealModelsAreImported) {
    std::size_t files = 0;
    for (const auto& folder : fs::directory_iterator(data)) {
        if (!folder.is_directory() || folder.path() == corpus)
            continue;
        for (const fs::path& path : gltf_files_under(folder.path())) {
            SCOPED_TRACE(path.string());
            const auto map = import_path(path);
            ASSERT_TRUE(map.has_value()) << map.error();
            expect_sound(*map);
            EXPECT_GT(drawn_triangles(*map), 0u);
            ++files;
        }
    }
    EXPECT_GT(files, 100u);
}

TEST_F(Corpus, DamagedJpegIsTextureOrSentence) {
    const FileBytes sound = bytes_of(text_of(data / "C_sponza/textures/vase_hanging.jpg"));
    if (sound.empty())
        GTEST_SKIP() << "no JPEG";
    EXPECT_TRUE(map::decode_texture(sound).has_value());
    std::mt19937 random(20240613);
    for (int n = 0; n < 400; ++n) {
        FileBytes damaged = sound;
        for (int k = 0; k < 3; ++k)
            damaged[random() % (n % 2 == 0 ? 700 : damaged.size())] = static_cast<std::uint8_t>(random());
        if (n % 5 == 0)
            damaged.resize(random() % damaged.size());
        const auto texture = map::decode_texture(damaged);
        if (!texture)
            expect_refused(texture, {});
    }
}

// A real file damaged, its buffers and pictures too.
TEST_F(Corpus, DamagedRealFilesAreMapOrSentence) {
    std::mt19937 random(20240613);
    for (const char* name : {"valid/texture_transform", "valid/vertex_colors", "valid/glb_padding",
                             "valid/uri_spaces", "valid/spec_gloss"}) {
        Files files;
        std::string root;
        for (const auto& entry : fs::recursive_directory_iterator(corpus / name)) {
            if (!entry.is_regular_file())
                continue;
            const std::string path = fs::relative(entry.path(), corpus / name).string();
            files[path] = bytes_of(text_of(entry.path()));
            if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
                root = path;
        }
        ASSERT_FALSE(root.empty()) << name;
        expect_accepted(import_files(files, {root}));
        for (int n = 0; n < 150; ++n) {
            Files damaged = files;
            auto victim = std::next(damaged.begin(), static_cast<std::ptrdiff_t>(random() % damaged.size()));
            for (int k = 0; k < 3; ++k)
                victim->second[random() %
                               std::min<std::size_t>(victim->second.size(), n % 2 == 0 ? 1000 : SIZE_MAX)] =
                    static_cast<std::uint8_t>(random());
            SCOPED_TRACE(std::string(name) + " " + std::to_string(n));
            const auto map = import_files(damaged, {root});
            if (map)
                expect_sound(*map);
            else
                expect_refused(map, {root});
        }
    }
}

}  // namespace
}  // namespace drtv::test
