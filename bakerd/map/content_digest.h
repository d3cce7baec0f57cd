// Digests of a map's content: they cover what can change a bake and nothing else.
#pragma once

#include "bakerd/map/digest.h"
#include "bakerd/map/map.h"

#include <cstdint>

namespace drtv::map {

// Each covers its argument and, by their digests, the things of the map that it names. REQUIRES: those
// digests are final.
[[nodiscard]] Digest digest_texture(const Texture& texture);
[[nodiscard]] Digest digest_material(const Material& material, const Map& map);
[[nodiscard]] Digest digest_primitive(const Primitive& primitive, const Map& map);
[[nodiscard]] Digest digest_mesh(const Mesh& mesh);
[[nodiscard]] Digest digest_object(const Object& object, const Map& map);
[[nodiscard]] Digest digest_volume(const VolumeNode& volume);
[[nodiscard]] Digest digest_light(const Light& light, const Map& map);

// A thing's group by its name, and nothing where it has none: the index depends on the files.
void add_light_group(Hasher& hasher, std::uint32_t light_group, const Map& map);

// Brings objects, probes, volumes and lights into an order that depends on content only, and digests it all.
// REQUIRES: each volume's `probe_name` is empty or a probe's.
void finish_content(Map& map);

}  // namespace drtv::map
