#include "bakerd/farm/job_request.h"

#include "bakerd/bake/tile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace drtv::farm {
namespace {

bool touches(const JobRegion& region, const map::SectorCoordinate& sector) {
    const double x = sector.i * map::sector_size_m;
    const double y = sector.j * map::sector_size_m;
    // A sector is half open: a region that ends on its eastern or northern border does not touch it from
    // inside.
    return region.x1 >= x && region.x0 < x + map::sector_size_m && region.y1 >= y &&
           region.y0 < y + map::sector_size_m;
}

}  // namespace

std::vector<map::SectorCoordinate> in_order_of_baking(std::vector<map::SectorCoordinate> sectors) {
    std::ranges::sort(sectors, {}, [](const map::SectorCoordinate& sector) {
        const map::SectorCoordinate tile = bake::tile_of(sector);
        return std::tuple(tile.j, tile.i, sector.j, sector.i);
    });
    return sectors;
}

store::Result<std::vector<map::SectorCoordinate>> sectors_of(
    const std::optional<JobRegion>& region, const std::vector<map::SectorCoordinate>& with_ground) {
    std::vector<map::SectorCoordinate> chosen;
    if (region) {
        for (double bound : {region->x0, region->y0, region->x1, region->y1}) {
            if (!std::isfinite(bound))
                return store::fail(store::ErrorCode::invalid_argument,
                                   fmt::format("the region's bound {} is not a number of metres", bound));
        }
        if (region->x0 > region->x1 || region->y0 > region->y1) {
            return store::fail(
                store::ErrorCode::invalid_argument,
                fmt::format(
                    "the region {},{},{},{} is empty: it must be X0,Y0,X1,Y1 with X0 <= X1 and Y0 <= Y1",
                    region->x0,
                    region->y0,
                    region->x1,
                    region->y1));
        }
        std::copy_if(with_ground.begin(),
                     with_ground.end(),
                     std::back_inserter(chosen),
                     [&](const map::SectorCoordinate& s) { return touches(*region, s); });
        if (chosen.empty()) {
            return store::fail(store::ErrorCode::invalid_argument,
                               fmt::format("the region {},{},{},{} touches no sector with ground",
                                           region->x0,
                                           region->y0,
                                           region->x1,
                                           region->y1));
        }
    } else {
        chosen = with_ground;
    }
    return in_order_of_baking(std::move(chosen));
}

}  // namespace drtv::farm
