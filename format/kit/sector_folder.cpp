#include "sector_folder.h"

#include "files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace drtv::kit {
namespace {

using Place = std::pair<std::int32_t, std::int32_t>;  // (i, j)

std::set<Place> wanted(const std::vector<Double3>& places) {
    std::set<Place> sectors;
    for (const Double3& place : places) {
        const double i = std::floor(place[0] / sector_size_m);
        const double j = std::floor(place[1] / sector_size_m);
        const bool exists = std::abs(i) <= max_sector_coordinate && std::abs(j) <= max_sector_coordinate;
        if (!exists)
            continue;
        for (int dj = -SectorFolder::reach; dj <= SectorFolder::reach; ++dj) {
            for (int di = -SectorFolder::reach; di <= SectorFolder::reach; ++di)
                sectors.insert({static_cast<std::int32_t>(i) + di, static_cast<std::int32_t>(j) + dj});
        }
    }
    return sectors;
}

}  // namespace

std::optional<std::pair<std::int32_t, std::int32_t>> nearest_sector(const std::string& path,
                                                                    double x,
                                                                    double y) {
    const auto distance_to = [=](const Place& place) {
        return std::hypot((place.first + 0.5) * sector_size_m - x, (place.second + 0.5) * sector_size_m - y);
    };
    std::optional<Place> nearest;
    for (const std::string& file : sector_files(path).value_or(FilePaths())) {
        const auto place = sector_of_file(file);
        if (place && (!nearest || distance_to(*place) < distance_to(*nearest)))
            nearest = place;
    }
    return nearest;
}

template <class IsWanted>
cli::Result<void> SectorFolder::load_if(const std::string& path, const IsWanted& is_wanted) {
    const auto files = sector_files(path);
    if (!files)
        return tl::unexpected(files.error());
    std::map<Place, std::string> named;
    SectorSetLimits limits{0, 0, 0, 0};
    for (const std::string& file : *files) {
        const auto place = sector_of_file(file);
        // A file that does not even say its sector may be one that is wanted.
        if (place && !is_wanted(*place))
            continue;
        auto sector = load_raw_sector(file);
        if (!sector)
            return tl::unexpected(sector.error());
        const SectorView& view = sector->view;
        const auto [entry, added] = named.try_emplace({view.i, view.j}, file);
        if (!added)
            return cli::fail(cli::exit_invalid, entry->second + " and " + file + " hold the same sector");
        ++limits.sectors;
        ++limits.tiles;
        limits.probes += static_cast<std::uint32_t>(view.probe_count);
        limits.interiors += static_cast<std::uint32_t>(view.interiors.size());
        files_.push_back(std::move(sector->bytes));
    }
    memory_.resize(SectorSet::memory_bytes(limits));
    set_ = std::make_unique<SectorSet>(memory_, limits);
    for (const auto& file : files_)
        set_->load(file);
    return {};
}

cli::Result<void> SectorFolder::load(const std::string& path, const std::vector<Double3>& places) {
    const std::set<Place> sectors = wanted(places);
    return load_if(path, [&](const Place& place) { return sectors.contains(place); });
}

cli::Result<void> SectorFolder::load(const std::string& path, const WorldSquare& square) {
    return load_if(path, [&](const Place& place) {
        const double x = place.first * sector_size_m;
        const double y = place.second * sector_size_m;
        return x < square.x1 && x + sector_size_m > square.x0 && y < square.y1 &&
               y + sector_size_m > square.y0;
    });
}

}  // namespace drtv::kit
