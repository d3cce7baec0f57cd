// A closed triangle mesh and the question whether a point is inside.
#pragma once

#include <glm/vec3.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::placement {

class ClosedVolume {
  public:
    // Vertices at equal positions are one (glTF splits them by normal). Where triangles are wound as a closed
    // surface they are taken so; else they are turned until they are, or it fails, with the end of a sentence
    // that begins with the mesh: when the surface is open, or not a surface.
    [[nodiscard]] static tl::expected<ClosedVolume, std::string> make(std::span<const glm::dvec3> positions,
                                                                      std::span<const glm::uvec3> triangles);

    // Whether the winding number around the point is not 0, or the point lies on the surface. Exact.
    // Thread-safe.
    [[nodiscard]] bool contains(const glm::dvec3& point) const;

    [[nodiscard]] const glm::dvec3& low() const;
    [[nodiscard]] const glm::dvec3& high() const;

    // The surface, its vertices merged and each of its parts turned outwards: all parts together are the
    // volume, whether they overlap, touch or stand in each other.
    [[nodiscard]] const std::vector<glm::dvec3>& vertices() const;
    [[nodiscard]] const std::vector<glm::uvec3>& triangles() const;  // counter-clockwise seen from outside

  private:
    struct Mesh;
    std::shared_ptr<const Mesh> mesh_;
};

}  // namespace drtv::placement
