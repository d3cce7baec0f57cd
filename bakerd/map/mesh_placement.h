// A mesh at its place in the world: an object of the map, or a volume.
#pragma once

#include "bakerd/map/import_state.h"
#include "bakerd/map/node_role.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <string>

namespace drtv::map {

struct MeshPlace {
    std::uint32_t mesh;  // index into Map::meshes
    glm::dmat4 world_from_object;
    std::string name;
    std::string where = {};  // of a volume: file and node, for messages
};

// Nothing of a map lies farther from the origin; what is no number does.
inline constexpr double max_distance_m = 1e9;
[[nodiscard]] bool is_far(const glm::dvec3& position);
inline constexpr const char* far_sentence = "it reaches farther than 10^9 m from the origin";

// Whether a part of it has a material that emits light.
[[nodiscard]] bool shines(const Mesh& mesh, const Map& map);

// Places the meshes of one document's nodes. Instancing lets a small file ask for much, so what is placed is
// counted, and refused beyond limits that are far above any real map. Sentences name neither file nor node;
// the caller does.
class MeshPlacer {
  public:
    MeshPlacer(Map& map, Shared& shared) : map_(map), shared_(shared) {}

    // To be asked before the instances of a node are placed.
    [[nodiscard]] Imported count(std::uint32_t mesh, const NodePurpose& purpose, std::size_t instances);

    // REQUIRES: the place is counted; the role is not `ignore` or `probe`.
    [[nodiscard]] Imported place(MeshPlace place, const NodePurpose& purpose);

  private:
    [[nodiscard]] std::size_t vertices_of(std::uint32_t mesh) const;
    [[nodiscard]] Imported count_copied(std::uint32_t mesh, std::size_t instances);
    [[nodiscard]] std::uint32_t flattened_mesh(std::uint32_t mesh, const glm::mat4x3& world_from_object);
    [[nodiscard]] Imported add_object(MeshPlace place, const NodePurpose& purpose);
    [[nodiscard]] Imported add_volume(const MeshPlace& place, VolumeNode volume);

    Map& map_;
    Shared& shared_;
    std::size_t placed_vertices_ = 0;
    std::size_t copied_vertices_ = 0;
};

}  // namespace drtv::map
