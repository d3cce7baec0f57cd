// Parts of the world, from above.
#pragma once

#include <drtv/sector_set.h>

#include <glm/vec2.hpp>

namespace drtv::picture {

// Of the world, metres; x east, y north.
struct Rectangle {
    glm::vec2 low{};
    glm::vec2 high{};
};

[[nodiscard]] bool overlap(const Rectangle& a, const Rectangle& b);

[[nodiscard]] Rectangle square_of(const LoadedSector& sector);
// Of all sectors of a set.
[[nodiscard]] Rectangle extent_of(const SectorSet& set);

}  // namespace drtv::picture
