// Skinned meshes, in the pose in which the file has them.
#pragma once

#include "bakerd/map/mesh_attributes.h"

#include <glm/mat4x4.hpp>

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

// Where a skin's joints take the vertices that hang on them: from the mesh's own axes to the scene's. The
// transform of the node that has the mesh takes no part (glTF 2.0, 3.7.3.3).
struct SkinPose {
    int skin;
    std::vector<glm::dmat4> scene_from_mesh;  // by joint
};

class Skins {
  public:
    // REQUIRES: the document outlives it.
    explicit Skins(const GltfDocument& document) : document_(document), poses_(document.model.skins.size()) {}

    // The sentence names file and skin.
    [[nodiscard]] tl::expected<const SkinPose*, std::string> pose_of(int skin);

  private:
    [[nodiscard]] tl::expected<SkinPose, std::string> read_pose(int skin);
    // The transform of each node of the document, its parents' included.
    [[nodiscard]] tl::expected<void, std::string> find_node_places();

    const GltfDocument& document_;
    std::vector<std::optional<SkinPose>> poses_;
    std::vector<glm::dmat4> scene_from_node_;  // by node; empty before a pose is asked for
};

// Moves the primitive's positions, 3 numbers a vertex, to where their joints hold them. The sentence names
// file and primitive.
[[nodiscard]] tl::expected<void, std::string> take_pose(const SkinPose& pose,
                                                        const GltfDocument& document,
                                                        const NamedPrimitive& primitive,
                                                        Floats& positions);

}  // namespace drtv::map
