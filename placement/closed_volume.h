// A closed triangle mesh and the question whether a point is inside (CGAL).
#pragma once

#include <glm/vec3.hpp>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::placement {

class ClosedVolume {
  public:
    // Vertices at equal positions are one (glTF splits them by normal). Fails with a sentence naming the
    // volume when the surface is open or not a surface.
    [[nodiscard]] static tl::expected<ClosedVolume, std::string> make(std::string_view name,
                                                                      std::span<const glm::dvec3> positions,
                                                                      std::span<const glm::uvec3> triangles);

    // Inside or on the boundary. Thread-safe.
    [[nodiscard]] bool contains(const glm::dvec3& point) const;

    // The surface, its vertices merged and each of its parts turned outwards, in the order of the mesh it was
    // made of.
    [[nodiscard]] std::vector<glm::dvec3> vertices() const;
    [[nodiscard]] std::vector<glm::uvec3> triangles() const;  // counter-clockwise seen from outside

  private:
    struct Mesh;
    std::shared_ptr<const Mesh> mesh_;
};

}  // namespace drtv::placement
