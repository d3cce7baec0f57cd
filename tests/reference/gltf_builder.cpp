#include "tests/reference/gltf_builder.h"

#include "bakerd/map/import.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace drtv::reference {
namespace {

using Bytes = std::vector<std::uint8_t>;
using nlohmann::json;

std::string base64(std::span<const std::uint8_t> bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t n = 0; n < bytes.size(); n += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (n + k < bytes.size() ? bytes[n + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += n + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    return text;
}

void put_big_endian(Bytes& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<std::uint8_t>(value >> shift));
}

// PNG (ISO 15948), 5.3: length, type, data, CRC of type and data.
void put_chunk(Bytes& out, const char* type, const Bytes& data) {
    put_big_endian(out, static_cast<std::uint32_t>(data.size()));
    const std::size_t start = out.size();
    out.insert(out.end(), type, type + 4);
    out.insert(out.end(), data.begin(), data.end());
    std::uint32_t crc = ~0u;
    for (std::size_t n = start; n < out.size(); ++n) {
        crc ^= out[n];
        for (int k = 0; k < 8; ++k)
            crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    put_big_endian(out, ~crc);
}

// World (x, y, z) is glTF (x, z, -y).
std::array<float, 3> gltf_from_world(const glm::vec3& p) {
    return {p.x, p.z, -p.y};
}
std::array<float, 3> gltf_scale(const glm::vec3& s) {
    return {s.x, s.z, s.y};
}
std::array<float, 4> gltf_rotation(double turn) {
    return {0, static_cast<float>(std::sin(turn / 2)), 0, static_cast<float>(std::cos(turn / 2))};
}

template <std::size_t size>
void append(std::vector<float>& out, const std::array<float, size>& values) {
    out.insert(out.end(), values.begin(), values.end());
}

// Appends to the array `name`, made when missing, and gives the element's index.
int append(json& root, const char* name, json element) {
    root[name].push_back(std::move(element));
    return static_cast<int>(root[name].size()) - 1;
}

template <class Value>
Bytes bytes_of(std::span<const Value> values) {
    Bytes bytes(values.size_bytes());
    if (!bytes.empty())
        std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

}  // namespace

Bytes encode_png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgba) {
    Bytes rows;
    for (std::uint32_t y = 0; y < height; ++y) {
        rows.push_back(0);  // no filter
        const auto row = rgba.subspan(std::size_t{y} * width * 4, std::size_t{width} * 4);
        rows.insert(rows.end(), row.begin(), row.end());
    }
    std::uint32_t a = 1, b = 0;  // Adler-32
    for (std::uint8_t byte : rows) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    const auto size = static_cast<std::uint16_t>(rows.size()), inverse = static_cast<std::uint16_t>(~size);
    Bytes zlib = {0x78, 0x01, 0x01};  // zlib, then one final stored block
    for (const std::uint16_t word : {size, inverse}) {
        zlib.push_back(static_cast<std::uint8_t>(word & 255));
        zlib.push_back(static_cast<std::uint8_t>(word >> 8));
    }
    zlib.insert(zlib.end(), rows.begin(), rows.end());
    put_big_endian(zlib, b << 16 | a);

    Bytes header;
    put_big_endian(header, width);
    put_big_endian(header, height);
    header.insert(header.end(), {8, 6, 0, 0, 0});  // 8 bits, RGBA
    Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    put_chunk(png, "IHDR", header);
    put_chunk(png, "IDAT", zlib);
    put_chunk(png, "IEND", {});
    return png;
}

void Patch::add_quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c, d});
    uvs.insert(uvs.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    triangles.emplace_back(first, first + 1, first + 2);
    triangles.emplace_back(first, first + 2, first + 3);
}

void Patch::add_box(const glm::vec3& l, const glm::vec3& h) {
    add_quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});  // up
    add_quad({l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, l.y, l.z}, {l.x, l.y, l.z});  // down
    add_quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});  // -y
    add_quad({h.x, h.y, l.z}, {l.x, h.y, l.z}, {l.x, h.y, h.z}, {h.x, h.y, h.z});  // +y
    add_quad({l.x, h.y, l.z}, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z});  // -x
    add_quad({h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z});  // +x
}

int GltfBuilder::add_view(std::span<const std::uint8_t> bytes) {
    const int buffer = append(
        root_, "buffers",
        {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
    return append(root_, "bufferViews", {{"buffer", buffer}, {"byteLength", bytes.size()}});
}

int GltfBuilder::add_accessor(std::span<const float> values, std::size_t components) {
    static constexpr std::array<const char*, 5> types = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    std::vector<float> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components)),
        high = low;
    for (std::size_t n = 0; n < values.size(); ++n) {
        low[n % components] = std::min(low[n % components], values[n]);
        high[n % components] = std::max(high[n % components], values[n]);
    }
    return append(root_, "accessors",
                  {{"bufferView", add_view(bytes_of(values))},
                   {"componentType", 5126},
                   {"type", types[components]},
                   {"count", values.size() / components},
                   {"min", low},
                   {"max", high}});
}

int GltfBuilder::add_accessor(std::span<const std::uint32_t> values) {
    return append(root_, "accessors",
                  {{"bufferView", add_view(bytes_of(values))},
                   {"componentType", 5125},
                   {"type", "SCALAR"},
                   {"count", values.size()}});
}

int GltfBuilder::add_texture(std::span<const std::uint8_t> png) {
    const int image = append(root_, "images", {{"uri", "data:image/png;base64," + base64(png)}});
    return append(root_, "textures", {{"source", image}});
}

int GltfBuilder::add_material(const Surfacing& surfacing) {
    const glm::vec4& colour = surfacing.base_colour;
    json material = {
        {"pbrMetallicRoughness", {{"baseColorFactor", {colour.x, colour.y, colour.z, colour.w}}}},
        {"doubleSided", surfacing.double_sided}};
    if (surfacing.texture >= 0)
        material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", surfacing.texture}};
    if (surfacing.masked) {
        material["alphaMode"] = "MASK";
        material["alphaCutoff"] = surfacing.alpha_cutoff;
    }
    if (surfacing.blended)
        material["alphaMode"] = "BLEND";
    if (surfacing.emission != glm::vec3(0)) {
        material["emissiveFactor"] = {surfacing.emission.x, surfacing.emission.y, surfacing.emission.z};
        material["extensions"]["KHR_materials_emissive_strength"] = {
            {"emissiveStrength", surfacing.emission_strength}};
        use_extension("KHR_materials_emissive_strength");
    }
    if (surfacing.emission_texture >= 0)
        material["emissiveTexture"] = {{"index", surfacing.emission_texture}};
    if (surfacing.clear > 0) {
        material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", surfacing.clear}};
        use_extension("KHR_materials_transmission");
    }
    if (surfacing.transmission > 0) {
        const glm::vec3& through = surfacing.transmission_colour;
        material["extensions"]["KHR_materials_diffuse_transmission"] = {
            {"diffuseTransmissionFactor", surfacing.transmission},
            {"diffuseTransmissionColorFactor", {through.x, through.y, through.z}}};
        use_extension("KHR_materials_diffuse_transmission");
    }
    return append(root_, "materials", std::move(material));
}

int GltfBuilder::add_mesh(std::span<const Patch> patches, std::span<const int> materials) {
    json primitives = json::array();
    for (std::size_t n = 0; n < patches.size(); ++n) {
        std::vector<float> positions, uvs, colours;
        std::vector<std::uint32_t> indices;
        for (const glm::vec3& p : patches[n].positions)
            append(positions, gltf_from_world(p));
        for (const glm::vec2& uv : patches[n].uvs)
            append(uvs, std::array<float, 2>{uv.x, uv.y});
        for (const glm::vec4& c : patches[n].colours)
            append(colours, std::array<float, 4>{c.x, c.y, c.z, c.w});
        for (const glm::uvec3& t : patches[n].triangles)
            indices.insert(indices.end(), {t.x, t.y, t.z});
        json primitive = {{"attributes", {{"POSITION", add_accessor(positions, 3)}}},
                          {"indices", add_accessor(indices)},
                          {"material", materials[n]}};
        if (!uvs.empty())
            primitive["attributes"]["TEXCOORD_0"] = add_accessor(uvs, 2);
        if (!colours.empty())
            primitive["attributes"]["COLOR_0"] = add_accessor(colours, 4);
        primitives.push_back(std::move(primitive));
    }
    return append(root_, "meshes", {{"primitives", std::move(primitives)}});
}

void GltfBuilder::place(int mesh, const Placement& placement, const std::string& role) {
    const int node = append(root_, "nodes",
                            {{"mesh", mesh},
                             {"translation", gltf_from_world(placement.shift_m)},
                             {"rotation", gltf_rotation(placement.turn_radians)},
                             {"scale", gltf_scale(placement.scale)},
                             {"extras", {{"bake_role", role}}}});
    root_["scenes"][0]["nodes"].push_back(node);
}

void GltfBuilder::place_instances(int mesh, std::span<const Placement> placements, const std::string& role) {
    std::vector<float> shifts, turns, scales;
    for (const Placement& placement : placements) {
        append(shifts, gltf_from_world(placement.shift_m));
        append(turns, gltf_rotation(placement.turn_radians));
        append(scales, gltf_scale(placement.scale));
    }
    const json attributes = {{"TRANSLATION", add_accessor(shifts, 3)},
                             {"ROTATION", add_accessor(turns, 4)},
                             {"SCALE", add_accessor(scales, 3)}};
    const int node = append(root_, "nodes",
                            {{"mesh", mesh},
                             {"extras", {{"bake_role", role}}},
                             {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    root_["scenes"][0]["nodes"].push_back(node);
    use_extension("EXT_mesh_gpu_instancing");
}

void GltfBuilder::place_lamp(const Lamp& lamp) {
    json light = {{"type", lamp.type},
                  {"color", {lamp.colour.x, lamp.colour.y, lamp.colour.z}},
                  {"intensity", lamp.intensity}};
    if (lamp.range_m > 0)
        light["range"] = lamp.range_m;
    if (lamp.type == "spot")
        light["spot"] = {{"innerConeAngle", lamp.inner_cone_radians},
                         {"outerConeAngle", lamp.outer_cone_radians}};
    const int index = append(root_["extensions"]["KHR_lights_punctual"], "lights", std::move(light));
    use_extension("KHR_lights_punctual");
    // The light shines along the node's -z, of glTF's axes: the shortest turn of (0, 0, -1) to the direction.
    const std::array<float, 3> d = gltf_from_world(glm::normalize(lamp.direction));
    const glm::dvec3 to(d[0], d[1], d[2]), axis = glm::cross(glm::dvec3(0, 0, -1), to);
    glm::dvec4 turn(axis, 1 - to.z);
    turn = glm::length(turn) < 1e-6 ? glm::dvec4(1, 0, 0, 0) : glm::normalize(turn);
    const int node = append(root_, "nodes",
                            {{"translation", gltf_from_world(lamp.position)},
                             {"rotation", {turn.x, turn.y, turn.z, turn.w}},
                             {"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}});
    root_["scenes"][0]["nodes"].push_back(node);
}

void GltfBuilder::use_extension(const std::string& name) {
    json& used = root_["extensionsUsed"];
    if (std::find(used.begin(), used.end(), name) == used.end())
        used.push_back(name);
}

map::Map GltfBuilder::import() const {
    const std::string text = root_.dump();
    const std::string path = "memory.gltf";
    auto map = map::import_map(
        {&path, 1}, [&](const std::string& wanted) -> tl::expected<map::FileBytes, map::FileFailure> {
            if (wanted != path)
                return tl::unexpected(map::FileFailure{"no file '" + wanted + "' in memory", true});
            return map::FileBytes(text.begin(), text.end());
        });
    if (!map)
        throw std::runtime_error(map.error());
    return std::move(*map);
}

}  // namespace drtv::reference
