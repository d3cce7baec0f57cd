#include "bakerd/farm/job_request.h"

#include "bakerd/bake/tile.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace drtv::farm {
namespace {

using Json = nlohmann::json;

bool touches(const Region& region, const map::SectorCoordinate& sector) {
    const double x = sector.i * map::sector_size_m, y = sector.j * map::sector_size_m;
    // A sector is half open: a region that ends on its eastern or northern border does not touch it from
    // inside.
    return region.x1 >= x && region.x0 < x + map::sector_size_m && region.y1 >= y &&
           region.y0 < y + map::sector_size_m;
}

}  // namespace

Result<bake::Settings> settings_of(const JobRequest& request) {
    auto settings = bake::preset(request.preset);
    if (!settings)
        return fail(ErrorCode::invalid_argument, settings.error());
    for (const auto& [key, value] : request.overrides) {
        if (auto set = bake::set(*settings, key, value); !set)
            return fail(ErrorCode::invalid_argument, set.error());
    }
    return *settings;
}

Result<std::vector<map::SectorCoordinate>> sectors_of(const std::optional<Region>& region,
                                                      const std::vector<map::SectorCoordinate>& with_ground) {
    std::vector<map::SectorCoordinate> chosen;
    if (region) {
        for (double bound : {region->x0, region->y0, region->x1, region->y1}) {
            if (!std::isfinite(bound))
                return fail(ErrorCode::invalid_argument,
                            fmt::format("the region's bound {} is not a number of metres", bound));
        }
        if (region->x0 > region->x1 || region->y0 > region->y1) {
            return fail(
                ErrorCode::invalid_argument,
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
            return fail(ErrorCode::invalid_argument,
                        fmt::format("the region {},{},{},{} touches no sector with ground",
                                    region->x0,
                                    region->y0,
                                    region->x1,
                                    region->y1));
        }
    } else {
        chosen = with_ground;
    }
    std::sort(
        chosen.begin(), chosen.end(), [](const map::SectorCoordinate& a, const map::SectorCoordinate& b) {
            const map::SectorCoordinate tile_a = bake::tile_of(a), tile_b = bake::tile_of(b);
            return std::tuple(tile_a.j, tile_a.i, a.j, a.i) < std::tuple(tile_b.j, tile_b.i, b.j, b.i);
        });
    return chosen;
}

std::string encode_region(const std::optional<Region>& region) {
    if (!region)
        return "";
    return Json::array({region->x0, region->y0, region->x1, region->y1}).dump();
}

std::optional<Region> decode_region(const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_array() || json.size() != 4)
        return std::nullopt;
    return Region{json[0].get<double>(), json[1].get<double>(), json[2].get<double>(), json[3].get<double>()};
}

std::string encode_overrides(const std::map<std::string, std::string>& overrides) {
    return Json(overrides).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::map<std::string, std::string> decode_overrides(const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    return json.is_object() ? json.get<std::map<std::string, std::string>>()
                            : std::map<std::string, std::string>();
}

}  // namespace drtv::farm
