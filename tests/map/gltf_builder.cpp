#include "tests/map/gltf_builder.h"

#include "bakerd/map/import.h"

#include <array>
#include <cstring>

namespace drtv::test {
namespace {

void add_big_endian(FileBytes& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void add_little_endian(FileBytes& out, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
    std::uint32_t crc = 0xFFFFFFFF;
    for (std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 1 ? crc >> 1 ^ 0xEDB88320 : crc >> 1;
    }
    return ~crc;
}

std::uint32_t adler32(std::span<const std::uint8_t> bytes) {
    std::uint32_t a = 1, b = 0;
    for (std::uint8_t byte : bytes) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

void add_chunk(FileBytes& png, const char* type, const FileBytes& data) {
    add_big_endian(png, static_cast<std::uint32_t>(data.size()));
    FileBytes checked(type, type + 4);
    checked.insert(checked.end(), data.begin(), data.end());
    png.insert(png.end(), checked.begin(), checked.end());
    add_big_endian(png, crc32(checked));
}

template <class Vector>
Json numbers(const Vector& v) {
    Json array = Json::array();
    for (glm::length_t k = 0; k < Vector::length(); ++k)
        array.push_back(v[k]);
    return array;
}

}  // namespace

Shape quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    return {{a, b, c, d}, {0, 1, 2, 0, 2, 3}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {}};
}

Shape ground(float half, float height) {
    return quad({-half, height, half}, {half, height, half}, {half, height, -half}, {-half, height, -half});
}

Shape triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return {{a, b, c}, {}, {}, {}};
}

Shape box(const glm::vec3& l, const glm::vec3& h) {
    const std::array<Shape, 6> sides = {
        quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z}),
        quad({h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z}),
        quad({h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}),
        quad({l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z}),
        quad({l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z}),
        quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z})};
    Shape all;
    for (const Shape& side : sides) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        for (std::uint32_t index : side.indices)
            all.indices.push_back(first + index);
        all.positions.insert(all.positions.end(), side.positions.begin(), side.positions.end());
        all.uvs.insert(all.uvs.end(), side.uvs.begin(), side.uvs.end());
    }
    return all;
}

glm::vec3 gltf_from_world(const glm::vec3& world) {
    return {world.x, world.z, -world.y};
}

FileBytes png_of(const Picture& picture) {
    FileBytes rows;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        rows.push_back(0);  // no filter
        const auto first = picture.rgba.begin() + std::ptrdiff_t{y} * picture.width * 4;
        rows.insert(rows.end(), first, first + std::ptrdiff_t{picture.width} * 4);
    }
    FileBytes zlib = {0x78, 0x01};
    for (std::size_t at = 0; at < rows.size(); at += 65535) {
        const auto size = static_cast<std::uint32_t>(std::min<std::size_t>(65535, rows.size() - at));
        zlib.push_back(at + size == rows.size());
        for (std::uint32_t value : {size, ~size}) {
            zlib.push_back(static_cast<std::uint8_t>(value));
            zlib.push_back(static_cast<std::uint8_t>(value >> 8));
        }
        zlib.insert(zlib.end(), rows.begin() + static_cast<std::ptrdiff_t>(at),
                    rows.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
    add_big_endian(zlib, adler32(rows));
    FileBytes header;
    add_big_endian(header, picture.width);
    add_big_endian(header, picture.height);
    header.insert(header.end(), {8, 6, 0, 0, 0});  // 8 bits, RGBA
    FileBytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    add_chunk(png, "IHDR", header);
    add_chunk(png, "IDAT", zlib);
    add_chunk(png, "IEND", {});
    return png;
}

std::string base64_of(std::span<const std::uint8_t> bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (at + k < bytes.size() ? bytes[at + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += at + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

map::FileSource source_of(Files files) {
    return [files = std::move(files)](const std::string& path) -> tl::expected<FileBytes, map::FileFailure> {
        const auto found = files.find(path);
        if (found == files.end())
            return tl::unexpected(
                map::FileFailure{"cannot read " + path + ": No such file or directory", true});
        return found->second;
    };
}

tl::expected<map::Map, std::string> import_files(const Files& files, const std::vector<std::string>& paths) {
    return map::import_map(paths, source_of(files));
}

FileBytes glb_of(const std::string& json, std::span<const std::uint8_t> bin) {
    const auto padded = [](std::size_t size) { return static_cast<std::uint32_t>((size + 3) / 4 * 4); };
    FileBytes glb = bytes_of("glTF");
    add_little_endian(glb, 2);
    add_little_endian(glb, 20 + padded(json.size()) + (bin.empty() ? 0 : 8 + padded(bin.size())));
    add_little_endian(glb, padded(json.size()));
    add_little_endian(glb, 0x4E4F534A);
    glb.insert(glb.end(), json.begin(), json.end());
    glb.resize(20 + padded(json.size()), ' ');
    if (bin.empty())
        return glb;
    add_little_endian(glb, padded(bin.size()));
    add_little_endian(glb, 0x004E4942);
    glb.insert(glb.end(), bin.begin(), bin.end());
    glb.resize((glb.size() + 3) / 4 * 4, 0);
    return glb;
}

int GltfBuilder::add(const char* array, Json element) {
    json[array].push_back(std::move(element));
    return static_cast<int>(json[array].size()) - 1;
}

int GltfBuilder::add_view(std::span<const std::uint8_t> bytes, int stride_bytes) {
    bin.resize((bin.size() + 3) / 4 * 4);
    Json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
    if (stride_bytes != 0)
        view["byteStride"] = stride_bytes;
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(view));
}

int GltfBuilder::add_accessor(int view, int component_type, const std::string& type, std::size_t count,
                              bool normalized) {
    Json accessor = {
        {"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}};
    if (normalized)
        accessor["normalized"] = true;
    return add("accessors", std::move(accessor));
}

int GltfBuilder::add_image(const Picture& picture) {
    return add("images", {{"bufferView", add_view(png_of(picture))}, {"mimeType", "image/png"}});
}

int GltfBuilder::add_texture(const Picture& picture, Json sampler) {
    Json texture = {{"source", add_image(picture)}};
    if (!sampler.is_null())
        texture["sampler"] = add("samplers", std::move(sampler));
    return add("textures", std::move(texture));
}

int GltfBuilder::add_material(const MaterialSource& source) {
    Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", numbers(source.colour)}}}};
    if (source.texture >= 0)
        material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", source.texture}};
    if (source.mask_cutoff)
        material.update({{"alphaMode", "MASK"}, {"alphaCutoff", *source.mask_cutoff}});
    if (source.double_sided)
        material["doubleSided"] = true;
    if (!source.name.empty())
        material["name"] = source.name;
    return add("materials", std::move(material));
}

int GltfBuilder::add_mesh(const Shape& shape, int material, int mode) {
    const int mesh = add("meshes", {{"primitives", Json::array()}});
    add_primitive(mesh, shape, material, mode);
    return mesh;
}

void GltfBuilder::add_primitive(int mesh, const Shape& shape, int material, int mode) {
    Json attributes = {{"POSITION", add_values(shape.positions, gltf_f32, "VEC3")}};
    if (!shape.uvs.empty())
        attributes["TEXCOORD_0"] = add_values(shape.uvs, gltf_f32, "VEC2");
    if (!shape.colours.empty())
        attributes["COLOR_0"] = add_values(shape.colours, gltf_f32, "VEC4");
    Json primitive = {{"attributes", attributes}};
    if (!shape.indices.empty())
        primitive["indices"] = add_values(shape.indices, gltf_u32, "SCALAR");
    if (material >= 0)
        primitive["material"] = material;
    if (mode != gltf_triangles)
        primitive["mode"] = mode;
    json["meshes"][static_cast<std::size_t>(mesh)]["primitives"].push_back(std::move(primitive));
}

int GltfBuilder::add_light(Json light) {
    json["extensionsUsed"] = {"KHR_lights_punctual"};
    Json& lights = json["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(light));
    return static_cast<int>(lights.size()) - 1;
}

int GltfBuilder::add_node(const NodeSource& source) {
    Json node = Json::object();
    if (source.mesh >= 0)
        node["mesh"] = source.mesh;
    if (source.light >= 0)
        node["extensions"]["KHR_lights_punctual"] = {{"light", source.light}};
    if (source.translation)
        node["translation"] = numbers(*source.translation);
    if (source.rotation)
        node["rotation"] = numbers(*source.rotation);
    if (source.scale)
        node["scale"] = numbers(*source.scale);
    if (!source.matrix.empty())
        node["matrix"] = source.matrix;
    if (!source.children.empty())
        node["children"] = source.children;
    if (!source.name.empty())
        node["name"] = source.name;
    if (!source.role.empty())
        node["extras"]["bake_role"] = source.role;
    if (!source.probe.empty())
        node["extras"]["bake_probe"] = source.probe;
    if (source.spacing > 0)
        node["extras"]["bake_spacing"] = source.spacing;
    if (source.light_group)
        node["extras"]["light_group"] = *source.light_group;
    return add("nodes", std::move(node));
}

int GltfBuilder::add_instances(int mesh, const std::vector<glm::vec3>& translations, const NodeSource& node) {
    NodeSource source = node;
    source.mesh = mesh;
    const int index = add_node(source);
    const int accessor = add_values(translations, gltf_f32, "VEC3");
    json["nodes"][static_cast<std::size_t>(index)]["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", {{"TRANSLATION", accessor}}}};
    return index;
}

Json GltfBuilder::document() const {
    Json document = json;
    if (!bin.empty() && !document.contains("buffers"))
        document["buffers"] = Json::array({Json::object({{"byteLength", bin.size()}})});
    if (!document.contains("nodes") || document.contains("scenes"))
        return document;
    std::vector<bool> is_child(document["nodes"].size(), false);
    for (const Json& node : document["nodes"]) {
        for (const Json& child : node.value("children", Json::array()))
            is_child[child.get<std::size_t>()] = true;
    }
    Json roots = Json::array();
    for (std::size_t n = 0; n < is_child.size(); ++n) {
        if (!is_child[n])
            roots.push_back(n);
    }
    document["scene"] = 0;
    document["scenes"] = Json::array({Json::object({{"nodes", roots}})});
    return document;
}

std::string GltfBuilder::gltf() const {
    return gltf("data:application/octet-stream;base64," + base64_of(bin));
}

std::string GltfBuilder::gltf(const std::string& buffer_uri) const {
    Json all = document();
    if (!bin.empty() && !all["buffers"][0].contains("uri"))
        all["buffers"][0]["uri"] = buffer_uri;
    return all.dump();
}

FileBytes GltfBuilder::glb() const {
    return glb_of(document().dump(), bin);
}

}  // namespace drtv::test
