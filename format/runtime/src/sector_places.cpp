// What lights a place: probes by the grids, interiors, tiles.
#include <drtv/sector_set.h>

#include "columns.h"
#include "vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drtv {
namespace {

// Height in cells above the grid's bottom; 0 for what is not a number.
double height_in_cells(const StoredGrid& grid, double z_m) {
    const double units = z_m * position_units_per_m - grid.z_origin_units;
    const double cells = units / grid.cell_height_units;
    return cells == cells ? cells : 0.0;
}

std::uint8_t probe_of_cell(const SectorView& sector, std::size_t x, std::size_t y, double z) {
    const auto cell_z = static_cast<std::size_t>(std::clamp(z, 0.0, double{grid_size - 1}));
    const std::uint8_t p = sector.grid->cells[x + grid_size * y + grid_size * grid_size * cell_z];
    return p < sector.probe_count ? p : no_probe;
}

// Gathers shares; a probe that several cells name stands once.
class Blend {
  public:
    void add(const LoadedSector* sector, std::uint8_t probe, float share) {
        if (!(share > 0))
            return;
        if (sector == nullptr || probe == no_probe) {
            blend_.fallback += share;
            return;
        }
        for (std::size_t n = 0; n < blend_.count; ++n) {
            ProbeShare& known = blend_.probes[n];
            if (known.sector == sector && known.probe == probe) {
                known.share += share;
                return;
            }
        }
        blend_.probes[blend_.count++] = {sector, probe, share};
    }

    // `without`: what to say where there are no probes.
    [[nodiscard]] ProbeBlend finish(PlaceStatus without) {
        blend_.status = blend_.fallback == 0 ? PlaceStatus::inside : PlaceStatus::fading;
        if (blend_.count == 0) {
            blend_.status = without;
            blend_.fallback = 1;
        }
        return blend_;
    }

  private:
    ProbeBlend blend_;
};

// Order among interiors of different sectors: the place's own first, then by the distance of the sectors'
// centres.
struct SectorRank {
    double distance_squared;
    std::int32_t j;
    std::int32_t i;

    bool operator<(const SectorRank& other) const {
        if (distance_squared != other.distance_squared)
            return distance_squared < other.distance_squared;
        return j != other.j ? j < other.j : i < other.i;
    }
};

SectorRank rank_of(const SectorView& sector, const Double3& world_m) {
    const auto [x_m, y_m, z_m] = world_m;
    const SectorId own = sector_of_columns(column_at(x_m, 0).index, column_at(y_m, 0).index);
    if (SectorId{sector.i, sector.j} == own)
        return {-1, 0, 0};
    const double x = (sector.i + 0.5) * side_m - x_m;
    const double y = (sector.j + 0.5) * side_m - y_m;
    return {x * x + y * y, sector.j, sector.i};
}

bool is_near(const InteriorBounds& bounds, const Double3& world_m, double distance_m) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (world_m[axis] < bounds.low[axis] - distance_m || world_m[axis] > bounds.high[axis] + distance_m)
            return false;
    }
    return true;
}

float interior_share(const SectorView& sector,
                     const StoredInterior& interior,
                     const Double3& world_m,
                     double soft) {
    if (!(soft > 0))
        return is_inside(sector, interior, world_m) ? 1 : 0;
    const double distance = signed_distance_m(sector, interior, world_m);
    return static_cast<float>(std::clamp(0.5 + distance / soft, 0.0, 1.0));
}

}  // namespace

ProbeBlend SectorSet::nearest(const Double3& world_m) const {
    const auto [x_m, y_m, z_m] = world_m;
    if (!in_reach(x_m) || !in_reach(y_m))
        return Blend().finish(PlaceStatus::sector_missing);
    const std::int64_t x = column_at(x_m, 0).index;
    const std::int64_t y = column_at(y_m, 0).index;
    const LoadedSector* sector = find(sector_of_columns(x, y));
    if (sector == nullptr)
        return Blend().finish(PlaceStatus::sector_missing);
    const double z = std::floor(height_in_cells(*sector->view.grid, z_m));
    Blend blend;
    blend.add(sector, probe_of_cell(sector->view, within_sector(x), within_sector(y), z), 1);
    return blend.finish(PlaceStatus::probe_missing);
}

ProbeBlend SectorSet::trilinear(const Double3& world_m) const {
    const auto [x_m, y_m, z_m] = world_m;
    if (!in_reach(x_m) || !in_reach(y_m))
        return Blend().finish(PlaceStatus::sector_missing);
    // Between the centres of cells.
    const Column x = column_at(x_m, 0.5);
    const Column y = column_at(y_m, 0.5);
    Blend blend;
    for (int n = 0; n < 4; ++n) {
        const bool next_x = (n & 1) != 0;
        const bool next_y = (n & 2) != 0;
        const float share = (next_x ? x.above : 1 - x.above) * (next_y ? y.above : 1 - y.above);
        const std::int64_t cx = x.index + (next_x ? 1 : 0);
        const std::int64_t cy = y.index + (next_y ? 1 : 0);
        const LoadedSector* sector = find(sector_of_columns(cx, cy));
        if (sector == nullptr) {
            blend.add(nullptr, no_probe, share);
            continue;
        }
        const double z =
            std::clamp(height_in_cells(*sector->view.grid, z_m) - 0.5, 0.0, double{grid_size - 1});
        const double low = std::floor(z);
        const float above = static_cast<float>(z - low);
        const auto probe = [&](double cell) {
            return probe_of_cell(sector->view, within_sector(cx), within_sector(cy), cell);
        };
        blend.add(sector, probe(low), share * (1 - above));
        blend.add(sector, probe(low + 1), share * above);
    }
    const bool has_sector =
        find(sector_of_columns(column_at(x_m, 0).index, column_at(y_m, 0).index)) != nullptr;
    return blend.finish(has_sector ? PlaceStatus::probe_missing : PlaceStatus::sector_missing);
}

InteriorShare SectorSet::interior(const Double3& world_m, float soft_m) const {
    const auto [x_m, y_m, z_m] = world_m;
    if (!in_reach(x_m) || !in_reach(y_m) || !std::isfinite(z_m))
        return {};
    const double soft = soft_m > 0 ? std::min(double{soft_m}, side_m) : 0.0;
    InteriorShare best;
    SectorRank best_rank{};
    for (std::uint32_t s = 0; s < slots_.size(); ++s) {
        const LoadedSector* sector = at(s);
        if (sector == nullptr || sector->view.interiors.empty())
            continue;
        const SectorRank rank = rank_of(sector->view, world_m);
        for (std::uint32_t n = 0; n < sector->view.interiors.size(); ++n) {
            if (!is_near(interior_bounds_[sector->first_interior + n], world_m, soft / 2))
                continue;
            const float share = interior_share(sector->view, sector->view.interiors[n], world_m, soft);
            const bool first_of_equals = share > 0 && share == best.share && rank < best_rank;
            if (share > best.share || first_of_equals) {
                best = {sector, n, share};
                best_rank = rank;
            }
        }
    }
    return best;
}

void SectorSet::find_outdoor_probes(const LoadedSector& sector) {
    const SectorView& view = sector.view;
    const auto outdoor = outdoor_probes_.subspan(sector.first_probe, view.probe_count);
    const auto is_indoors = [&](std::size_t p) {
        const Double3 place = exact_position_m(view, p);
        for (std::uint32_t n = 0; n < view.interiors.size(); ++n) {
            const StoredInterior& interior = view.interiors[n];
            if (interior.probe == p || (is_near(interior_bounds_[sector.first_interior + n], place, 0) &&
                                        is_inside(view, interior, place)))
                return true;
        }
        return false;
    };
    std::array<bool, max_probes> indoors{};
    for (std::size_t p = 0; p < view.probe_count; ++p)
        indoors[p] = is_indoors(p);
    for (std::size_t p = 0; p < view.probe_count; ++p) {
        std::size_t nearest = p;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t q = 0; indoors[p] && q < view.probe_count; ++q) {
            const double distance = squared_distance(exact_position_m(view, p), exact_position_m(view, q));
            if (indoors[q] || distance >= least)
                continue;
            least = distance;
            nearest = q;
        }
        outdoor[p] = static_cast<std::uint8_t>(nearest);
    }
}

ProbeBlend SectorSet::outdoors(const ProbeBlend& blend) const {
    Blend outdoors;
    for (std::size_t n = 0; n < blend.count; ++n) {
        const ProbeShare& probe = blend.probes[n];
        outdoors.add(probe.sector, outdoor_probes(*probe.sector)[probe.probe], probe.share);
    }
    outdoors.add(nullptr, no_probe, blend.fallback);
    return outdoors.finish(blend.status);
}

float SectorSet::sky_factor(const Double3& world_m) const {
    const auto [x_m, y_m, z_m] = world_m;
    if (!in_reach(x_m) || !in_reach(y_m))
        return 1;
    const Column x = column_at(x_m, 0.5);
    const Column y = column_at(y_m, 0.5);
    const auto factor = [&, z = z_m](std::int64_t cx, std::int64_t cy) {
        const SkyTile* found = tile(sector_of_columns(cx, cy));
        return found == nullptr ? 1.0f : drtv::sky_factor(*found, within_sector(cx), within_sector(cy), z);
    };
    const float south = factor(x.index, y.index) * (1 - x.above) + factor(x.index + 1, y.index) * x.above;
    const float north =
        factor(x.index, y.index + 1) * (1 - x.above) + factor(x.index + 1, y.index + 1) * x.above;
    return south * (1 - y.above) + north * y.above;
}

}  // namespace drtv
