// A small language for glTF in tests: a case is three to ten lines. Everything is in glTF's own axes (y up);
// what is added gets the index that glTF knows it by. `json` is open, so that a test can break or extend
// anything.
//
//     GltfBuilder b;
//     const int red = b.add_material({.colour = {1, 0, 0, 1}});
//     const int house = b.add_mesh(box({-1, 0, -1}, {1, 2, 1}), red);
//     b.add_node({.mesh = house, .translation = glm::dvec3(10, 0, 0), .role = "static"});
//     const auto map = b.import();
#pragma once

#include "bakerd/map/file_source.h"
#include "bakerd/map/map.h"
#include "tests/store/bytes_of.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::test {

using Json = nlohmann::json;
using map::FileBytes;

// glTF's names for numbers.
inline constexpr int gltf_i8 = 5120, gltf_u8 = 5121, gltf_i16 = 5122, gltf_u16 = 5123, gltf_u32 = 5125,
                     gltf_f32 = 5126;
inline constexpr int gltf_triangles = 4, gltf_strip = 5, gltf_fan = 6;

// Triangles with what may hang on their vertices; empty indices mean "as they stand".
struct Shape {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec4> colours;
};

[[nodiscard]] Shape box(const glm::vec3& low, const glm::vec3& high);  // 12 triangles, fronts outwards
// Corners counter-clockwise seen from the front; uvs (0,1) (1,1) (1,0) (0,0), so that a picture stands
// upright.
[[nodiscard]] Shape quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);
[[nodiscard]] Shape ground(float half_size_m,
                           float height_m = 0);  // one quad around the origin, front upwards
[[nodiscard]] Shape triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);  // not indexed
// The glTF position of a point given in world axes.
[[nodiscard]] glm::vec3 gltf_from_world(const glm::vec3& world);

struct Picture {
    std::uint32_t width = 1, height = 1;
    std::vector<std::uint8_t> rgba;  // rows from the top
};

[[nodiscard]] FileBytes png_of(const Picture& picture);  // with stored deflate blocks
[[nodiscard]] std::string base64_of(std::span<const std::uint8_t> bytes);

struct MaterialSource {
    glm::vec4 colour{1};
    std::optional<double> mask_cutoff = {};  // alphaMode MASK
    bool double_sided = false;
    int texture = -1;
    std::string name = {};
};

struct NodeSource {
    int mesh = -1, light = -1;
    std::optional<glm::dvec3> translation = {};
    std::optional<glm::dvec4> rotation = {};  // x, y, z, w
    std::optional<glm::dvec3> scale = {};
    std::vector<double> matrix = {};  // 16, column after column
    std::vector<int> children = {};
    std::string name = {}, role = {}, probe = {};  // extras: bake_role, bake_probe
    double spacing = 0;                            // and bake_spacing
    std::optional<std::string> light_group = {};   // and light_group
};

using Files = std::map<std::string, FileBytes>;

[[nodiscard]] map::FileSource source_of(Files files);
[[nodiscard]] tl::expected<map::Map, std::string> import_files(const Files& files,
                                                               const std::vector<std::string>& paths);
// A GLB of these chunks, padded as the format asks; no BIN chunk when `bin` is empty.
[[nodiscard]] FileBytes glb_of(const std::string& json, std::span<const std::uint8_t> bin);

class GltfBuilder {
  public:
    Json json = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::uint8_t> bin;  // buffer 0; nothing is said about it while it is empty

    // Appends to `bin`, aligned to 4; the index of its bufferView.
    int add_view(std::span<const std::uint8_t> bytes, int stride_bytes = 0);
    template <class Value>
    int add_view(const std::vector<Value>& values, int stride_bytes = 0) {
        return add_view(
            std::span(reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(Value)),
            stride_bytes);
    }
    int add_accessor(int view, int component_type, const std::string& type, std::size_t count,
                     bool normalized = false);
    template <class Value>
    int add_values(const std::vector<Value>& values, int component_type, const std::string& type,
                   bool normalized = false) {
        const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
        const std::size_t component_bytes = component_type <= gltf_u8    ? 1
                                            : component_type <= gltf_u16 ? 2
                                                                         : 4;
        return add_accessor(add_view(values), component_type, type,
                            values.size() * sizeof(Value) / (components * component_bytes), normalized);
    }

    int add_image(const Picture& picture);                       // inside the buffer
    int add_texture(const Picture& picture, Json sampler = {});  // e.g. {{"wrapS", 33071}}
    int add_material(const MaterialSource& source);
    int add_mesh(const Shape& shape, int material = -1, int mode = gltf_triangles);  // u32 indices
    // A further primitive in an existing mesh.
    void add_primitive(int mesh, const Shape& shape, int material = -1, int mode = gltf_triangles);
    int add_light(Json light);  // KHR_lights_punctual
    int add_node(const NodeSource& source);
    // EXT_mesh_gpu_instancing, by translation.
    int add_instances(int mesh, const std::vector<glm::vec3>& translations, const NodeSource& node = {});
    // A node that only places a mesh.
    int place(const Shape& shape, const std::string& role = "", int material = -1) {
        return add_node({.mesh = add_mesh(shape, material), .role = role});
    }

    // The document. Its scene holds all nodes that are nobody's child, unless the test wrote `scenes` itself.
    [[nodiscard]] Json document() const;
    [[nodiscard]] std::string gltf() const;                               // buffer as data URI
    [[nodiscard]] std::string gltf(const std::string& buffer_uri) const;  // buffer in a file
    [[nodiscard]] FileBytes glb() const;
    [[nodiscard]] Files files(const std::string& name = "map.gltf") const {
        return {{name, bytes_of(gltf())}};
    }
    [[nodiscard]] tl::expected<map::Map, std::string> import() const {
        return import_files(files(), {"map.gltf"});
    }

  private:
    int add(const char* array, Json element);
};

}  // namespace drtv::test
