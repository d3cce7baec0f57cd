// What a client asks for, and the sectors that this means.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/map/ground.h"
#include "bakerd/store/error.h"
#include "settings/bake_settings.h"

#include <optional>
#include <string>
#include <vector>

namespace drtv::farm {

// World metres; both ends touch.
struct JobRegion {
    double x0 = 0;
    double y0 = 0;
    double x1 = 0;
    double y1 = 0;
};

struct JobRequest {
    map::Digest manifest;
    std::string preset;              // the settings' origin, to be shown
    settings::JobSettings settings;  // each in its range (settings::check)
    std::optional<JobRegion> region;
    executor::Priority priority = executor::Priority::interactive;
    std::string owner{};
    std::string label{};
    std::string request_id{};  // empty, or at most 64 bytes
};

// 8 x 8 tiles after each other, so that neighbours share a scene.
[[nodiscard]] std::vector<map::SectorCoordinate> in_order_of_baking(
    std::vector<map::SectorCoordinate> sectors);

// Of the map's sectors with ground those the region touches, in the order of baking. invalid_argument when
// the region is wrong or touches none.
[[nodiscard]] store::Result<std::vector<map::SectorCoordinate>> sectors_of(
    const std::optional<JobRegion>& region, const std::vector<map::SectorCoordinate>& with_ground);

}  // namespace drtv::farm
