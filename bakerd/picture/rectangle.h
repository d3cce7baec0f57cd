// Parts of the world, from above.
#pragma once

#include "bakerd/trace/scene.h"

#include <drtv/sector_set.h>

namespace drtv::picture {

[[nodiscard]] bool overlap(const trace::WorldRectangle& a, const trace::WorldRectangle& b);

[[nodiscard]] trace::WorldRectangle square_of(const LoadedSector& sector);
// Of all sectors of a set.
[[nodiscard]] trace::WorldRectangle extent_of(const SectorSet& set);

}  // namespace drtv::picture
