// Accessors and primitives: index types, strips, fans, strides, sparse, quantised, where the buffer lies.
#include "tests/map/gltf_builder.h"
#include "tests/map/import_checks.h"

#include <cstring>

namespace drtv::test {
namespace {

using map::Map;

// The corners of the only mesh's triangles, in glTF axes.
std::vector<glm::vec3> corners_of(const GltfBuilder& b) {
    const Map map = expect_accepted(b.import());
    std::vector<glm::vec3> corners;
    for (const map::Mesh& mesh : map.meshes) {
        for (const map::Primitive& primitive : mesh.primitives) {
            for (const glm::uvec3& t : primitive.triangles) {
                for (glm::length_t k = 0; k < 3; ++k)
                    corners.push_back(primitive.positions.at(t[k]));
            }
        }
    }
    return corners;
}

const glm::vec3 A{0, 0, 0}, B{1, 0, 0}, C{0, 1, 0}, D{1, 1, 0}, E{2, 1, 0};
using Corners = std::vector<glm::vec3>;

GltfBuilder mesh_of(const Corners& positions, int mode = gltf_triangles) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh({positions, {}, {}, {}}, -1, mode)});
    return b;
}

template <class Index>
void set_indices(GltfBuilder& b, const std::vector<Index>& indices, int component_type) {
    b.json["meshes"][0]["primitives"][0]["indices"] = b.add_values(indices, component_type, "SCALAR");
}

TEST(Primitive, WithoutIndicesTakesVerticesAsTheyStand) {
    EXPECT_EQ(corners_of(mesh_of({A, B, C, B, D, C})), (Corners{A, B, C, B, D, C}));
}

TEST(Primitive, IncompleteLastTriangleIsLeftOut) {
    EXPECT_EQ(corners_of(mesh_of({A, B, C, D, E})), (Corners{A, B, C}));
}

TEST(Primitive, IndicesOfAllWidthsAreRead) {
    GltfBuilder u8 = mesh_of({A, B, C, D}), u16 = u8, u32 = u8;
    set_indices<std::uint8_t>(u8, {3, 2, 1}, gltf_u8);
    set_indices<std::uint16_t>(u16, {3, 2, 1}, gltf_u16);
    set_indices<std::uint32_t>(u32, {3, 2, 1}, gltf_u32);
    for (const GltfBuilder& b : {u8, u16, u32})
        EXPECT_EQ(corners_of(b), (Corners{D, C, B}));
}

TEST(Primitive, StripAlternatesItsWinding) {
    EXPECT_EQ(corners_of(mesh_of({A, B, C, D, E}, gltf_strip)), (Corners{A, B, C, B, D, C, C, D, E}));
}

TEST(Primitive, FanTurnsAboutItsFirstVertex) {
    EXPECT_EQ(corners_of(mesh_of({A, B, E, D, C}, gltf_fan)), (Corners{B, E, A, E, D, A, D, C, A}));
}

TEST(Primitive, IndexedStripKeepsWindingOverDegenerates) {
    GltfBuilder b = mesh_of({A, B, C, D}, gltf_strip);
    set_indices<std::uint8_t>(b, {0, 1, 2, 2, 1, 3}, gltf_u8);  // (0 1 2), two without area, (2 1 3) turned
    EXPECT_EQ(corners_of(b), (Corners{A, B, C, C, D, B}));
}

TEST(Primitive, PointsAndLinesBlockNothing) {
    for (int mode : {0, 1, 2, 3})
        EXPECT_TRUE(expect_accepted(mesh_of({A, B, C}, mode).import()).objects.empty()) << mode;
}

TEST(Primitive, WithoutPositionsIsSkipped) {
    GltfBuilder b;
    b.place(ground(1));
    b.add_primitive(0, {{A, B, C}, {0, 1, 2}, {}, {}});
    Json& attributes = b.json["meshes"][0]["primitives"][1]["attributes"];
    attributes["NORMAL"] = attributes["POSITION"];
    attributes.erase("POSITION");
    EXPECT_EQ(corners_of(b).size(), 6u);
}

TEST(Primitive, UnusedVerticesAreDropped) {
    GltfBuilder b = mesh_of({E, E, A, E, B, C, E});
    set_indices<std::uint8_t>(b, {5, 2, 4}, gltf_u8);
    const Map map = expect_accepted(b.import());
    EXPECT_EQ(map.meshes.at(0).primitives.at(0).positions, (Corners{C, A, B}));
    expect_near(map.meshes[0].bounds.high, {1, 1, 0});
}

TEST(Primitive, InterleavedViewIsRead) {
    GltfBuilder b = mesh_of({A, B, C});
    b.json["bufferViews"][0]["byteStride"] = 24;
    b.json["bufferViews"][0]["byteLength"] = 72;
    b.json["accessors"][0]["byteOffset"] = 4;
    b.bin.assign(72, 0);
    const float one = 1;
    std::memcpy(&b.bin[24 + 4], &one, 4);  // B.x
    std::memcpy(&b.bin[48 + 8], &one, 4);  // C.y
    EXPECT_EQ(corners_of(b), (Corners{A, B, C}));
}

TEST(Primitive, IntegerWrittenAsAFloatIsAnInteger) {
    GltfBuilder b = mesh_of({A, B, C, D});
    set_indices<std::uint8_t>(b, {3, 2, 1}, gltf_u8);
    std::string text = b.gltf();
    for (const auto& [from, to] : {std::pair{"\"POSITION\":0", "\"POSITION\":0.0"},
                                   {"\"mesh\":0", "\"mesh\":0e1"},
                                   {"\"indices\":1", "\"indices\":10e-1"},
                                   {"\"nodes\":[0]", "\"nodes\":[0.0]"},
                                   {"\"count\":3", "\"count\":3.0"}}) {
        ASSERT_NE(text.find(from), std::string::npos) << from;
        text.replace(text.find(from), std::string(from).size(), to);
    }
    const Map map = expect_accepted(import_files({{"map.gltf", bytes_of(text)}}, {"map.gltf"}));
    ASSERT_EQ(map.objects.size(), 1u);
    EXPECT_EQ(map.objects[0].digest, expect_accepted(b.import()).objects.at(0).digest);
}

TEST(Accessor, SparseReplacesElements) {
    GltfBuilder b = mesh_of({A, B, A});
    const int indices = b.add_view(std::vector<std::uint16_t>{2}),
              values = b.add_view(std::vector<glm::vec3>{C});
    b.json["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", indices}, {"componentType", gltf_u16}}},
                                        {"values", {{"bufferView", values}}}};
    EXPECT_EQ(corners_of(b), (Corners{A, B, C}));
}

TEST(Accessor, SparseWithoutViewStartsAtZero) {
    GltfBuilder b = mesh_of({E, E, E});
    const int indices = b.add_view(std::vector<std::uint32_t>{1, 2}),
              values = b.add_view(std::vector<glm::vec3>{B, C});
    b.json["accessors"][0].erase("bufferView");
    b.json["accessors"][0]["sparse"] = {{"count", 2},
                                        {"indices", {{"bufferView", indices}, {"componentType", gltf_u32}}},
                                        {"values", {{"bufferView", values}}}};
    EXPECT_EQ(corners_of(b), (Corners{A, B, C}));
}

TEST(Accessor, SparseIndicesOfTrianglesWork) {
    GltfBuilder b = mesh_of({A, B, C, D});
    set_indices<std::uint8_t>(b, {0, 1, 2}, gltf_u8);
    const int indices = b.add_view(std::vector<std::uint8_t>{0}),
              values = b.add_view(std::vector<std::uint8_t>{3});
    b.json["accessors"][1]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", indices}, {"componentType", gltf_u8}}},
                                        {"values", {{"bufferView", values}}}};
    EXPECT_EQ(corners_of(b), (Corners{D, B, C}));
}

// KHR_mesh_quantization: a byte is max(b / 127, -1), a ushort u / 65535; unnormalised integers are
// themselves.
TEST(Accessor, QuantisedPositionsAreRead) {
    GltfBuilder b = mesh_of({A, B, C});
    b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
    const auto first = [&] { return corners_of(b).at(0); };
    // Each vertex padded to 4 components: the format asks for alignment.
    const auto use = [&](int view, int type, bool normalized) {
        attributes["POSITION"] = b.add_accessor(view, type, "VEC3", 3, normalized);
    };
    const int bytes = b.add_view(std::vector<std::int8_t>{127, -128, -127, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 4);
    use(bytes, gltf_i8, true);
    EXPECT_EQ(first(), glm::vec3(1, -1, -1));
    use(bytes, gltf_i8, false);
    EXPECT_EQ(first(), glm::vec3(127, -128, -127));
    use(bytes, gltf_u8, false);
    EXPECT_EQ(first(), glm::vec3(127, 128, 129));
    use(bytes, gltf_u8, true);
    EXPECT_EQ(first(), glm::vec3(127 / 255.0f, 128 / 255.0f, 129 / 255.0f));
    const int shorts = b.add_view(std::vector<std::int16_t>{32767, -32768, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 8);
    use(shorts, gltf_i16, true);
    EXPECT_EQ(first(), glm::vec3(1, -1, -1 / 32767.0f));
    use(shorts, gltf_i16, false);
    EXPECT_EQ(first(), glm::vec3(32767, -32768, -1));
    use(shorts, gltf_u16, true);
    EXPECT_EQ(first(), glm::vec3(32767 / 65535.0f, 32768 / 65535.0f, 1));
    use(shorts, gltf_u16, false);
    EXPECT_EQ(first(), glm::vec3(32767, 32768, 65535));
}

TEST(Buffer, MayBeEmbeddedExternalOrInAGlb) {
    GltfBuilder b;
    b.place(box({0, 0, 0}, {1, 2, 3}));
    const auto embedded = expect_accepted(b.import()).content;
    EXPECT_EQ(
        expect_accepted(import_files({{"m.gltf", bytes_of(b.gltf("m.bin"))}, {"m.bin", b.bin}}, {"m.gltf"}))
            .content,
        embedded);
    EXPECT_EQ(expect_accepted(import_files({{"m.glb", b.glb()}}, {"m.glb"})).content, embedded);
    // A GLB may also use files.
    EXPECT_EQ(
        expect_accepted(import_files({{"m.glb", glb_of(b.gltf("m.bin"), {})}, {"m.bin", b.bin}}, {"m.glb"}))
            .content,
        embedded);
    EXPECT_EQ(expect_accepted(import_files({{"m.glb", glb_of(b.gltf(), {})}}, {"m.glb"})).content, embedded);
}

TEST(Buffer, MayBeLongerThanItSays) {
    GltfBuilder b;
    b.place(ground(1));
    FileBytes longer = b.bin;
    longer.resize(longer.size() + 3);
    b.json["buffers"] = Json::array({Json::object({{"byteLength", b.bin.size()}})});
    EXPECT_EQ(
        expect_accepted(import_files({{"m.gltf", bytes_of(b.gltf("m.bin"))}, {"m.bin", longer}}, {"m.gltf"}))
            .objects.size(),
        1u);
    EXPECT_EQ(expect_accepted(import_files({{"m.glb", glb_of(b.document().dump(), longer)}}, {"m.glb"}))
                  .objects.size(),
              1u);
    b.bin = longer;
    EXPECT_EQ(expect_accepted(b.import()).objects.size(), 1u);
}

TEST(Buffer, DataUriMayHaveAnyMediaType) {
    GltfBuilder b;
    b.place(ground(1));
    for (const std::string type : {"", "application/gltf-buffer", "application/octet-stream",
                                   "application/x-anything;charset=utf-8"}) {
        EXPECT_EQ(
            expect_accepted(
                import_files({{"m.gltf", bytes_of(b.gltf("data:" + type + ";base64," + base64_of(b.bin)))}},
                             {"m.gltf"}))
                .objects.size(),
            1u)
            << type;
    }
}

TEST(Glb, BytesBehindItsLengthAreIgnored) {
    GltfBuilder b;
    b.place(ground(1));
    FileBytes glb = b.glb();
    glb.resize(glb.size() + 5, 'x');
    EXPECT_EQ(expect_accepted(import_files({{"m.glb", glb}}, {"m.glb"})).objects.size(), 1u);
}

TEST(Glb, UnknownChunksAreIgnored) {
    GltfBuilder b;
    b.place(ground(1));
    FileBytes glb = b.glb();
    glb.insert(glb.end(), {4, 0, 0, 0, 'X', 'T', 'R', 'A', 1, 2, 3, 4});
    glb[8] = static_cast<std::uint8_t>(glb.size());
    glb[9] = static_cast<std::uint8_t>(glb.size() >> 8);
    EXPECT_EQ(expect_accepted(import_files({{"m.glb", glb}}, {"m.glb"})).objects.size(), 1u);
}

}  // namespace
}  // namespace drtv::test
