// What a client asks for, checked: settings out of preset and overrides, sectors out of map and region.
#pragma once

#include "bakerd/bake/settings.h"
#include "bakerd/map/ground.h"
#include "bakerd/store/error.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drtv::farm {

// World metres; both ends touch.
struct Region {
    double x0 = 0;
    double y0 = 0;
    double x1 = 0;
    double y1 = 0;
};

struct JobRequest {
    map::Digest manifest;
    std::string preset;
    std::map<std::string, std::string> overrides;  // as text
    std::optional<Region> region;
    std::string request_id;  // empty, or at most 64 bytes
};

[[nodiscard]] store::Result<bake::Settings> settings_of(const JobRequest& request);

// 8 x 8 tiles after each other, so that neighbours share a scene.
[[nodiscard]] std::vector<map::SectorCoordinate> in_order_of_baking(
    std::vector<map::SectorCoordinate> sectors);

// Of the map's sectors with ground those the region touches, in the order of baking. invalid_argument when
// the region is wrong or touches none.
[[nodiscard]] store::Result<std::vector<map::SectorCoordinate>> sectors_of(
    const std::optional<Region>& region, const std::vector<map::SectorCoordinate>& with_ground);

}  // namespace drtv::farm
