// Triangles made a closed surface whose parts all look outwards.
#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::placement {

struct ClosedSurface {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;  // counter-clockwise seen from outside
};

// A part is what hangs together by edges. One that is closed as it is wound stays so, and may touch itself in
// edges of four triangles; of another the triangles are turned until it is. Fails with the end of a sentence
// that begins with the volume.
[[nodiscard]] tl::expected<ClosedSurface, std::string> closed_surface(std::span<const glm::dvec3> positions,
                                                                      std::span<const glm::uvec3> triangles);

}  // namespace drtv::placement
