#include <drtv/sector_set.h>

#include "arena.h"
#include "search.h"

#include <algorithm>
#include <limits>

namespace drtv {
namespace {

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

struct SetMemory {
    std::size_t slots;
    std::size_t tiles;
    std::size_t slot_table;
    std::size_t tile_table;
    std::size_t interiors;
    std::size_t probes;
};

SetMemory counts_of(const SectorSetLimits& limits) {
    return {limits.sectors,
            limits.tiles,
            table_size(limits.sectors),
            table_size(limits.tiles),
            limits.interiors,
            limits.probes};
}

}  // namespace

const char* sentence_of(LoadStatus status) {
    switch (status) {
        case LoadStatus::loaded:
            return "it is loaded";
        case LoadStatus::unreadable:
            return "it cannot be read";
        case LoadStatus::already_there:
            return "its sector is there already";
        case LoadStatus::no_room:
            break;
    }
    return "there is no room for it: the limits of the set are reached";
}

std::size_t SectorSet::memory_bytes(const SectorSetLimits& limits) {
    const SetMemory counts = counts_of(limits);
    return Arena::bytes_of<Slot>(counts.slots) + Arena::bytes_of<TableEntry>(counts.slot_table) +
           Arena::bytes_of<TileEntry>(counts.tiles) + Arena::bytes_of<TableEntry>(counts.tile_table) +
           Arena::bytes_of<InteriorBounds>(counts.interiors) + Arena::bytes_of<std::uint8_t>(counts.probes);
}

SectorSet::SectorSet(std::span<std::byte> memory, const SectorSetLimits& limits) : limits_(limits) {
    const SetMemory counts = counts_of(limits);
    Arena arena(memory);
    slots_ = arena.take<Slot>(counts.slots);
    slot_table_ = arena.take<TableEntry>(counts.slot_table);
    tiles_ = arena.take<TileEntry>(counts.tiles);
    tile_table_ = arena.take<TableEntry>(counts.tile_table);
    interior_bounds_ = arena.take<InteriorBounds>(counts.interiors);
    outdoor_probes_ = arena.take<std::uint8_t>(counts.probes);
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
    const std::size_t index = index_where(
        slots_, [](const Slot& s) { return s.state.load(std::memory_order_relaxed) == SlotState::free; });
    const auto interiors = static_cast<std::uint32_t>(view.interiors.size());
    const std::uint32_t first_probe =
        free_run(static_cast<std::uint32_t>(view.probe_count), limits_.probes, false);
    const std::uint32_t first_interior = free_run(interiors, limits_.interiors, true);
    if (index == slots_.size() || first_probe == none || first_interior == none)
        return LoadStatus::no_room;

    Slot& slot = slots_[index];
    slot.sector = {view, static_cast<std::uint32_t>(index), first_probe, first_interior, ++loads_};
    for (std::uint32_t n = 0; n < interiors; ++n)
        interior_bounds_[first_interior + n] = bounds_of(view, view.interiors[n]);
    find_outdoor_probes(slot.sector);
    keep_tile(sky_tile_of(view));
    slot.state.store(SlotState::loaded, std::memory_order_release);
    entry.store(slot.sector.slot + 1, std::memory_order_release);
    if (loaded != nullptr)
        *loaded = &slot.sector;
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

// Beside readers: the place of one that is replaced is free after `retire`.
void SectorSet::keep_tile(const SkyTile& tile) {
    if (tiles_.empty())
        return;
    TableEntry& entry = tile_entry({tile.i, tile.j});
    const std::uint32_t value = entry.load(std::memory_order_relaxed);
    if (value != 0 && tiles_[value - 1].tile == tile)
        return;
    const std::size_t free = index_where(tiles_, [](const TileEntry& t) { return !t.used; });
    if (free == tiles_.size())
        return;
    tiles_[free] = {tile, true};
    entry.store(static_cast<std::uint32_t>(free) + 1, std::memory_order_release);
}

const SkyTile* SectorSet::tile(SectorId id) const {
    const std::uint32_t value = tiles_.empty() ? 0 : tile_entry(id).load(std::memory_order_acquire);
    return value == 0 ? find_tile(file_tiles_, id.i, id.j) : &tiles_[value - 1].tile;
}

}  // namespace drtv
