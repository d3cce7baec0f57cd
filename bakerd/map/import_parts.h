// The steps of the import, one file each: materials, meshes, nodes, digests.
#pragma once

#include "bakerd/map/gltf_document.h"
#include "bakerd/map/map.h"

#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

using Imported = tl::expected<void, std::string>;

// Index into Map::materials of each glTF material of one document that some primitive wears (UINT32_MAX of
// the others); the last one is glTF's default material.
using MaterialIndices = std::vector<std::uint32_t>;

// Equal things of several documents (or of one) are kept once: digest -> index.
struct Shared {
    struct HashDigest {
        std::size_t operator()(const Digest& digest) const {
            std::size_t value = 0;
            for (std::size_t k = 0; k < sizeof value; ++k)
                value = value << 8 | digest.bytes[k];
            return value;
        }
    };
    std::unordered_map<Digest, std::uint32_t, HashDigest> textures, materials, meshes;
    std::unordered_map<std::uint32_t, glm::vec3> brightest;  // by texture
    std::set<std::string> warned_of_brightness;              // file and material
};

// One line of sensible length, whatever stands in the names that the file gave.
[[nodiscard]] std::string as_sentence(std::string text);

// Adds a warning to the map, once.
void warn(Map& map, const std::string& text);

// "material 3 ('wall')".
[[nodiscard]] std::string name_of_material(const GltfDocument& document, std::size_t material);

[[nodiscard]] tl::expected<MaterialIndices, std::string> import_materials(const GltfDocument& document,
                                                                          Map& map,
                                                                          Shared& shared);

// Whether all primitives together can be read in sensible time and memory.
[[nodiscard]] Imported check_mesh_sizes(const GltfDocument& document);

// One glTF mesh; an index into Map::meshes, or no_mesh when it has no triangles.
inline constexpr std::uint32_t no_mesh = UINT32_MAX;
[[nodiscard]] tl::expected<std::uint32_t, std::string> import_mesh(const GltfDocument& document,
                                                                   std::size_t mesh,
                                                                   const MaterialIndices& materials,
                                                                   Map& map,
                                                                   Shared& shared);

// One punctual light but for its place and name. The sentence names the light.
[[nodiscard]] tl::expected<Light, std::string> import_light(const tinygltf::Model& model, int number);

// The default scene's nodes: objects, probes, volumes, lights.
[[nodiscard]] Imported import_nodes(const GltfDocument& document,
                                    const MaterialIndices& materials,
                                    Map& map,
                                    Shared& shared);

[[nodiscard]] Digest digest_texture(const Texture& texture);
[[nodiscard]] Digest digest_material(const Material& material, const Map& map);
[[nodiscard]] Digest digest_primitive(const Primitive& primitive, const Map& map);
[[nodiscard]] Digest digest_mesh(const Mesh& mesh);
[[nodiscard]] Digest digest_object(const Object& object, const Map& map);
[[nodiscard]] Digest digest_volume(const Volume& volume);

[[nodiscard]] Digest digest_light(const Light& light);

// Brings objects, probes, volumes and lights into an order that depends on content only, and digests it all.
// REQUIRES: each volume's `probe_name` is empty or a probe's.
void finish_content(Map& map);

}  // namespace drtv::map
