// What a client asks for, checked: settings out of preset and overrides, sectors out of map and region.
#pragma once

#include "bakerd/bake/settings.h"
#include "bakerd/farm/error.h"
#include "bakerd/map/ground.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drtv::farm {

// World metres; both ends touch.
struct Region {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct JobRequest {
    map::Digest manifest;
    std::string preset;
    std::map<std::string, std::string> overrides;  // as text
    std::optional<Region> region;
    std::string request_id;  // empty, or at most 64 bytes
};

[[nodiscard]] Result<bake::Settings> settings_of(const JobRequest& request);

// Of the map's sectors with ground those the region touches, in the order of baking: 8 x 8 tiles after each
// other, so that neighbours share a scene. invalid_argument when the region is wrong or touches none.
[[nodiscard]] Result<std::vector<map::SectorCoordinate>> sectors_of(
    const std::optional<Region>& region, const std::vector<map::SectorCoordinate>& with_ground);

// As the database keeps them.
[[nodiscard]] std::string encode_region(const std::optional<Region>& region);
[[nodiscard]] std::optional<Region> decode_region(const std::string& text);
[[nodiscard]] std::string encode_overrides(const std::map<std::string, std::string>& overrides);
[[nodiscard]] std::map<std::string, std::string> decode_overrides(const std::string& text);

}  // namespace drtv::farm
