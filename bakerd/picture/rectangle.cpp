#include "bakerd/picture/rectangle.h"

#include "format/kit/sector_folder.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <cmath>

namespace drtv::picture {

trace::WorldRectangle square_of(const LoadedSector& sector) {
    const auto side = static_cast<float>(sector_size_m);
    const glm::vec2 low = glm::vec2(sector.view.i, sector.view.j) * side;
    return {low, low + side};
}

trace::WorldRectangle extent_of(const SectorSet& set) {
    trace::WorldRectangle extent{glm::vec2(INFINITY), glm::vec2(-INFINITY)};
    kit::for_each_sector(set, [&](const LoadedSector& sector) {
        const trace::WorldRectangle square = square_of(sector);
        extent = {glm::min(extent.low, square.low), glm::max(extent.high, square.high)};
    });
    return extent;
}

bool overlap(const trace::WorldRectangle& a, const trace::WorldRectangle& b) {
    return glm::all(glm::lessThan(a.low, b.high)) && glm::all(glm::lessThan(b.low, a.high));
}

}  // namespace drtv::picture
