// A map as a flat list of world-space triangles in double precision, with a ray query of its own. It shares the
// map loader with the product and nothing else: no Embree, no instances, no float arithmetic.
#pragma once

#include "bakerd/map/map.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace drtv::reference {

struct SurfaceHit {
    double distance_m = 0;
    glm::dvec3 normal{};     // unit, on the ray's side
    glm::dvec3 albedo{};     // linear Rec. 709, within [0, 0.95]
    bool absorbs = false;    // the back of a one-sided surface
};

class Scene {
  public:
    // REQUIRES: `map` outlives the scene.
    explicit Scene(const map::Map& map);

    // The closest hit along the unit `direction`, or nothing. Masked texels let the ray through.
    [[nodiscard]] std::optional<SurfaceHit> closest(const glm::dvec3& origin, const glm::dvec3& direction) const;

    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }

  private:
    struct Triangle {
        glm::dvec3 corner, edge1, edge2;
        glm::dvec3 front;  // unit normal of the side that is counter-clockwise in object space
        const map::Primitive* primitive = nullptr;
        glm::uvec3 vertices{};
        bool two_sided = false;
    };
    // A leaf when `count` > 0: triangles [first, first + count); else its children are first and first + 1.
    struct Node {
        glm::dvec3 low, high;
        std::uint32_t first = 0, count = 0;
    };

    void split(std::size_t node);
    [[nodiscard]] bool meets(const Node& node, const glm::dvec3& origin, const glm::dvec3& inverse, double far) const;
    // Colour (w is alpha) before clamping, at weights u and v of the second and third vertex.
    [[nodiscard]] glm::dvec4 colour(const Triangle& triangle, double u, double v) const;

    const map::Map& map_;
    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace drtv::reference
