#include <drtv/sector_set.h>

#include "arena.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv {
namespace {

constexpr double side_m = sector_size_m;
constexpr double cell_m = side_m / grid_size;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// Room for twice as many as there may be, so that searches are short and end.
std::size_t table_size(std::uint32_t entries) {
    std::size_t size = 2;
    while (size < 2 * std::size_t{entries})
        size *= 2;
    return size;
}

std::size_t hash_of(SectorId id) {
    // Mixing of two 32-bit numbers (finaliser of SplitMix64).
    auto bits =
        static_cast<std::uint64_t>(static_cast<std::uint32_t>(id.i)) << 32 | static_cast<std::uint32_t>(id.j);
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    return static_cast<std::size_t>(bits ^ (bits >> 31));
}

// The entry that holds what is sought, or the empty one where it would stand.
template <class Entry, class IsIt>
Entry& entry_of(std::span<Entry> table, SectorId id, const IsIt& is_it) {
    for (std::size_t n = hash_of(id);; ++n) {
        Entry& entry = table[n & (table.size() - 1)];
        const std::uint32_t value = entry.load(std::memory_order_acquire);
        if (value == 0 || is_it(value - 1))
            return entry;
    }
}

SectorId id_of(const SectorView& sector) {
    return {sector.i, sector.j};
}

// Column of 4 m along one axis, of the whole world. REQUIRES: the place is finite.
struct Column {
    std::int64_t index;
    float above;  // share of the next one, 0 to 1, where columns are taken at their centres
};

// Whether a file can lie there at all: also, that cells can be counted.
bool in_reach(double metres) {
    constexpr double reach_m = (double{max_sector_coordinate} + 2) * side_m;
    return std::abs(metres) <= reach_m;
}

Column column_at(double metres, double first_centre) {
    const double cells = metres / cell_m - first_centre;
    const double low = std::floor(cells);
    return {static_cast<std::int64_t>(low), static_cast<float>(cells - low)};
}

SectorId sector_of_columns(std::int64_t x, std::int64_t y) {
    constexpr int bits = 4;
    static_assert(std::size_t{1} << bits == grid_size);
    return {static_cast<std::int32_t>(x >> bits), static_cast<std::int32_t>(y >> bits)};
}

std::size_t within_sector(std::int64_t column) {
    return static_cast<std::size_t>(column) % grid_size;
}

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

struct SetMemory {
    std::size_t slots;
    std::size_t tiles;
    std::size_t slot_table;
    std::size_t tile_table;
    std::size_t interiors;
};

SetMemory counts_of(const SectorSetLimits& limits) {
    return {
        limits.sectors, limits.tiles, table_size(limits.sectors), table_size(limits.tiles), limits.interiors};
}

}  // namespace

std::size_t SectorSet::memory_bytes(const SectorSetLimits& limits) {
    const SetMemory counts = counts_of(limits);
    return Arena::bytes_of<Slot>(counts.slots) + Arena::bytes_of<TableEntry>(counts.slot_table) +
           Arena::bytes_of<TileEntry>(counts.tiles) + Arena::bytes_of<TableEntry>(counts.tile_table) +
           Arena::bytes_of<InteriorBounds>(counts.interiors);
}

SectorSet::SectorSet(std::span<std::byte> memory, const SectorSetLimits& limits) : limits_(limits) {
    const SetMemory counts = counts_of(limits);
    Arena arena(memory);
    slots_ = arena.take<Slot>(counts.slots);
    slot_table_ = arena.take<TableEntry>(counts.slot_table);
    tiles_ = arena.take<TileEntry>(counts.tiles);
    tile_table_ = arena.take<TableEntry>(counts.tile_table);
    interior_bounds_ = arena.take<InteriorBounds>(counts.interiors);
}

const LoadedSector* SectorSet::at(std::uint32_t slot) const {
    const Slot& entry = slots_[slot];
    return entry.state.load(std::memory_order_acquire) == SlotState::loaded ? &entry.sector : nullptr;
}

const LoadedSector* SectorSet::find(SectorId id) const {
    const TableEntry& entry =
        entry_of(slot_table_, id, [&](std::uint32_t n) { return id_of(slots_[n].sector.view) == id; });
    const std::uint32_t value = entry.load(std::memory_order_acquire);
    return value == 0 ? nullptr : at(value - 1);
}

// First fit among the runs of sectors that are loaded or dropped. `none` where there is none.
std::uint32_t SectorSet::free_run(std::uint32_t length, std::uint32_t limit, bool interiors) const {
    const auto run_of = [&](const Slot& slot) {
        const LoadedSector& sector = slot.sector;
        return interiors ? std::pair(sector.first_interior, sector.view.interiors.size())
                         : std::pair(sector.first_probe, sector.view.probe_count);
    };
    std::uint32_t start = 0;
    for (bool moved = true; moved;) {
        moved = false;
        for (const Slot& slot : slots_) {
            if (slot.state.load(std::memory_order_relaxed) == SlotState::free)
                continue;
            const auto [first, count] = run_of(slot);
            if (start < first + count && first < start + length) {
                start = first + static_cast<std::uint32_t>(count);
                moved = true;
            }
        }
    }
    return length <= limit && start <= limit - length ? start : none;
}

LoadStatus SectorSet::load(std::span<const std::uint8_t> file, const LoadedSector** loaded, ReadStatus* why) {
    SectorView view;
    ReadStatus status = open_sector(file, view);
    const bool readable = status.ok();
    if (why != nullptr)
        *why = std::move(status);
    if (!readable)
        return LoadStatus::unreadable;
    const SectorId id = id_of(view);
    TableEntry& entry =
        entry_of(slot_table_, id, [&](std::uint32_t n) { return id_of(slots_[n].sector.view) == id; });
    if (entry.load(std::memory_order_relaxed) != 0)
        return LoadStatus::already_there;
    const auto slot = std::find_if(slots_.begin(), slots_.end(), [](const Slot& s) {
        return s.state.load(std::memory_order_relaxed) == SlotState::free;
    });
    const auto interiors = static_cast<std::uint32_t>(view.interiors.size());
    const std::uint32_t first_probe =
        free_run(static_cast<std::uint32_t>(view.probe_count), limits_.probes, false);
    const std::uint32_t first_interior = free_run(interiors, limits_.interiors, true);
    if (slot == slots_.end() || first_probe == none || first_interior == none)
        return LoadStatus::no_room;

    const auto index = static_cast<std::uint32_t>(slot - slots_.begin());
    slot->sector = {view, index, first_probe, first_interior};
    for (std::uint32_t n = 0; n < interiors; ++n)
        interior_bounds_[first_interior + n] = bounds_of(view, view.interiors[n]);
    keep_tile(sky_tile_of(view), true);
    slot->state.store(SlotState::loaded, std::memory_order_release);
    entry.store(index + 1, std::memory_order_release);
    if (loaded != nullptr)
        *loaded = &slot->sector;
    return LoadStatus::loaded;
}

bool SectorSet::drop(SectorId id) {
    const LoadedSector* sector = find(id);
    if (sector == nullptr)
        return false;
    slots_[sector->slot].state.store(SlotState::dropped, std::memory_order_release);
    return true;
}

void SectorSet::retire() {
    for (TableEntry& entry : slot_table_)
        entry.store(0, std::memory_order_relaxed);
    for (Slot& slot : slots_) {
        if (slot.state.load(std::memory_order_relaxed) != SlotState::loaded) {
            slot.state.store(SlotState::free, std::memory_order_relaxed);
            continue;
        }
        const SectorId id = id_of(slot.sector.view);
        entry_of(slot_table_, id, [](std::uint32_t) {
            return false;
        }).store(slot.sector.slot + 1, std::memory_order_relaxed);
    }
    // Tiles that a later one has replaced.
    for (std::uint32_t n = 0; n < tiles_.size(); ++n) {
        TileEntry& tile = tiles_[n];
        if (tile.used && this->tile({tile.tile.i, tile.tile.j}) != &tile.tile)
            tile.used = false;
    }
}

SectorSet::TableEntry& SectorSet::tile_entry(SectorId id) const {
    return entry_of(tile_table_, id, [&](std::uint32_t n) {
        return SectorId{tiles_[n].tile.i, tiles_[n].tile.j} == id;
    });
}

bool SectorSet::keep_tile(const SkyTile& tile, bool replace) {
    if (tiles_.empty())
        return false;
    TableEntry& entry = tile_entry({tile.i, tile.j});
    const std::uint32_t value = entry.load(std::memory_order_relaxed);
    if (value != 0 && (!replace || tiles_[value - 1].tile == tile))
        return true;
    const auto free = std::find_if(tiles_.begin(), tiles_.end(), [](const TileEntry& t) { return !t.used; });
    if (free == tiles_.end())
        return false;
    *free = {tile, true};
    entry.store(static_cast<std::uint32_t>(free - tiles_.begin()) + 1, std::memory_order_release);
    return true;
}

bool SectorSet::add_tile(const SkyTile& tile) {
    return keep_tile(tile, false);
}

const SkyTile* SectorSet::tile(SectorId id) const {
    if (tiles_.empty())
        return nullptr;
    const std::uint32_t value = tile_entry(id).load(std::memory_order_acquire);
    return value == 0 ? nullptr : &tiles_[value - 1].tile;
}

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
    const SectorId own = sector_of_columns(column_at(x_m, 0).index, column_at(y_m, 0).index);
    const double soft = soft_m > 0 ? std::min(double{soft_m}, side_m) : 0.0;
    struct Rank {
        double distance_squared;
        std::int32_t j;
        std::int32_t i;

        bool operator<(const Rank& other) const {
            if (distance_squared != other.distance_squared)
                return distance_squared < other.distance_squared;
            return j != other.j ? j < other.j : i < other.i;
        }
    };
    const auto rank_of = [&](const SectorView& sector) {
        if (id_of(sector) == own)
            return Rank{-1, 0, 0};
        const double x = (sector.i + 0.5) * side_m - x_m;
        const double y = (sector.j + 0.5) * side_m - y_m;
        return Rank{x * x + y * y, sector.j, sector.i};
    };
    InteriorShare best;
    Rank best_rank{};
    for (std::uint32_t s = 0; s < slots_.size(); ++s) {
        const LoadedSector* sector = at(s);
        if (sector == nullptr || sector->view.interiors.empty())
            continue;
        const Rank rank = rank_of(sector->view);
        for (std::uint32_t n = 0; n < sector->view.interiors.size(); ++n) {
            const InteriorBounds& bounds = interior_bounds_[sector->first_interior + n];
            bool near = true;
            for (std::size_t axis = 0; axis < 3; ++axis)
                near = near && world_m[axis] >= bounds.low[axis] - soft / 2 &&
                       world_m[axis] <= bounds.high[axis] + soft / 2;
            if (!near)
                continue;
            const StoredInterior& interior = sector->view.interiors[n];
            float share = 0;
            if (soft > 0) {
                const double distance = signed_distance_m(sector->view, interior, world_m);
                share = static_cast<float>(std::clamp(0.5 + distance / soft, 0.0, 1.0));
            } else {
                share = is_inside(sector->view, interior, world_m) ? 1 : 0;
            }
            if (share > best.share || (share > 0 && share == best.share && rank < best_rank)) {
                best = {sector, n, share};
                best_rank = rank;
            }
        }
    }
    return best;
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

std::size_t wanted_sectors(const Double3& camera_m, double radius_m, std::span<SectorId> out) {
    const auto [x_m, y_m, z_m] = camera_m;
    if (!in_reach(x_m) || !in_reach(y_m) || !(radius_m >= 0) || out.empty())
        return 0;
    const double radius = std::min(radius_m, 4.0 * max_sector_coordinate * side_m);
    const SectorId centre = sector_of_columns(column_at(x_m, 0).index, column_at(y_m, 0).index);
    struct Place {
        double distance_squared;
        SectorId id;
    };
    const auto place_of = [&, x = x_m, y = y_m](SectorId id) {
        const double dx = x - std::clamp(x, id.i * side_m, (id.i + 1.0) * side_m);
        const double dy = y - std::clamp(y, id.j * side_m, (id.j + 1.0) * side_m);
        return Place{dx * dx + dy * dy, id};
    };
    const auto before = [](const Place& a, const Place& b) {
        if (a.distance_squared != b.distance_squared)
            return a.distance_squared < b.distance_squared;
        return a.id.j != b.id.j ? a.id.j < b.id.j : a.id.i < b.id.i;
    };
    std::size_t count = 0;
    // Sorted as they come; the last gives way where there is no room.
    const auto add = [&](SectorId id) {
        const bool exists =
            std::abs(id.i) <= max_sector_coordinate && std::abs(id.j) <= max_sector_coordinate;
        const Place place = place_of(id);
        if (!exists || place.distance_squared > radius * radius)
            return;
        if (count == out.size() && !before(place, place_of(out[count - 1])))
            return;
        std::size_t n = count < out.size() ? count++ : count - 1;
        for (; n > 0 && before(place, place_of(out[n - 1])); --n)
            out[n] = out[n - 1];
        out[n] = id;
    };
    // Rings of sectors around that of the camera, until a ring is out of reach, or behind all that was found.
    for (std::int32_t ring = 0; ring <= 2 * max_sector_coordinate + 4; ++ring) {
        const double least = std::max(ring - 1, 0) * side_m;
        const bool full = count == out.size();
        if (least > radius || (full && least * least > place_of(out[count - 1]).distance_squared))
            break;
        for (std::int32_t j = -ring; j <= ring; ++j) {
            const bool whole_row = j == -ring || j == ring;
            for (std::int32_t i = -ring; i <= ring; i += whole_row ? 1 : std::max(2 * ring, 1))
                add({centre.i + i, centre.j + j});
        }
    }
    return count;
}

}  // namespace drtv
