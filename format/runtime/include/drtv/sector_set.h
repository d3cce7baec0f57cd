// The sectors that a game has in memory: opened where their files lie, loaded and dropped in any order, asked
// for the probes that light a place. Any number of cameras and volumes (drtv/volume.h) work over one set.
//
// Memory: the caller's, one piece, nothing is allocated after that. The files' bytes stay the caller's too,
// and must stay where they are until `retire` after `drop`.
//
// Threads: const calls may run on any number of threads, beside one thread that loads and drops. `retire`
// runs alone: a game calls it once per frame, where no other call is under way. What was dropped is gone for
// the next call, and its bytes may be unmapped after the next `retire`.
//
//     std::vector<std::byte> memory(drtv::SectorSet::memory_bytes({}));
//     drtv::SectorSet set(memory, {});
//     set.load(file_bytes);                                    // a raw sector file, at a multiple of 16
//     drtv::ProbeBlend blend = set.trilinear({x, y, z});       // up to 8 probes, and the fallback's share
#pragma once

#include <drtv/read.h>
#include <drtv/sky_tile.h>
#include <drtv/view.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drtv {

// Memory grows with each: some 600 bytes per sector, 800 per tile, 48 per interior, 1 per probe.
struct SectorSetLimits {
    std::uint32_t sectors = 64;
    std::uint32_t probes = 64 * max_probes;  // of all sectors together; each takes a run without gaps
    std::uint32_t interiors = 256;           // likewise
    std::uint32_t tiles = 4096;              // kept of sectors that are loaded or were
};

struct SectorId {
    std::int32_t i = 0;
    std::int32_t j = 0;

    bool operator==(const SectorId&) const = default;
};

enum class LoadStatus : std::uint8_t {
    loaded,
    unreadable,     // what open_sector says
    already_there,  // the set has this sector; one that was dropped counts until `retire`
    no_room,        // a limit is reached, or no run of free probes is long enough
};

// A sentence: "there is no room for it", ...
[[nodiscard]] const char* sentence_of(LoadStatus status);

// What is known of a place.
enum class PlaceStatus : std::uint8_t {
    inside,          // probes alone
    fading,          // probes, and a share of the fallback
    sector_missing,  // the fallback: the sector of the place is not in the set
    probe_missing,   // the fallback: the grid names no probe there
};

// A loaded sector. `first_probe` numbers the probes of all sectors: its probe p is first_probe + p, below
// SectorSetLimits::probes, from load to retire.
struct LoadedSector {
    SectorView view;
    std::uint32_t slot = 0;  // below SectorSetLimits::sectors
    std::uint32_t first_probe = 0;
    std::uint32_t first_interior = 0;
    std::uint64_t load = 0;  // counts loads from 1: tells a sector from what had the slot before
};

struct ProbeShare {
    const LoadedSector* sector = nullptr;
    std::uint8_t probe = 0;
    float share = 0;
};

// Shares add up to 1 with that of the fallback: an open sky without ground.
struct ProbeBlend {
    std::array<ProbeShare, 8> probes{};
    std::size_t count = 0;
    float fallback = 0;
    PlaceStatus status = PlaceStatus::sector_missing;
};

// An interior that holds a place, or nearly.
struct InteriorShare {
    const LoadedSector* sector = nullptr;  // null: none
    std::uint32_t index = 0;               // of sector->view.interiors
    float share = 0;                       // of its probe; the rest is what lights the place outside
};

class SectorSet {
  public:
    // Enough for any piece of memory that starts at a multiple of 16.
    [[nodiscard]] static std::size_t memory_bytes(const SectorSetLimits& limits);

    // REQUIRES: memory.size() >= memory_bytes(limits), it starts at a multiple of 16, and lives as long as
    // this.
    SectorSet(std::span<std::byte> memory, const SectorSetLimits& limits);
    SectorSet(const SectorSet&) = delete;
    SectorSet& operator=(const SectorSet&) = delete;

    // Opens a raw sector file and makes its tile. `why`, where given, gets what open_sector says, `loaded`
    // the sector. Cost: the checksum of the file's bytes, some 20 us for 15 KB; and
    // for each probe within the bounds of an interior as much as one is_inside.
    LoadStatus load(std::span<const std::uint8_t> file,
                    const LoadedSector** loaded = nullptr,
                    ReadStatus* why = nullptr);
    // False where it is not there. The tile is kept.
    bool drop(SectorId id);
    // What was dropped makes room. Alone: no other call may be under way.
    void retire();

    // Null where it is not loaded.
    [[nodiscard]] const LoadedSector* find(SectorId id) const;
    // All that are loaded, by slot: null where a slot has none. REQUIRES: slot < limits().sectors.
    [[nodiscard]] const LoadedSector* at(std::uint32_t slot) const;
    [[nodiscard]] const SectorSetLimits& limits() const { return limits_; }

    // The probe that the grid of the place's sector names (slide 54). One share, or the fallback.
    [[nodiscard]] ProbeBlend nearest(const Double3& world_m) const;
    // Eight cells around the place, continuous across sectors and holes: each column between its own two
    // cells, then the four columns.
    [[nodiscard]] ProbeBlend trilinear(const Double3& world_m) const;

    // The interior with the largest share, at a distance of d inside its mesh (below 0 outside) and a
    // softness above 0: clamp(1/2 + d / soft, 0, 1). Ties go to the place's own sector, then to the nearest
    // (by its centre, j, i), then to the first in the file. With a softness of 0, inside is 1 and outside 0.
    [[nodiscard]] InteriorShare interior(const Double3& world_m, float soft_m = 1) const;

    // What each probe of a sector is outdoors. One that stands inside an interior of its sector, or that such
    // a one names, does not light what is outside: the probe that stands nearest to it and is none of them
    // does (ties go to the first). All others, and all where each is one, stand for themselves. REQUIRES,
    // also below: sectors of this set.
    [[nodiscard]] std::span<const std::uint8_t> outdoor_probes(const LoadedSector& sector) const {
        return outdoor_probes_.subspan(sector.first_probe, sector.view.probe_count);
    }
    // A blend with these: what lights a place that is in no interior.
    [[nodiscard]] ProbeBlend outdoors(const ProbeBlend& blend) const;

    // What is left of the open sky's ambient light (drtv/sky_tile.h), between the four nearest columns. Of
    // sectors without a tile: 1.
    [[nodiscard]] float sky_factor(const Double3& world_m) const;

    // Tiles of a file (open_tiles), for sectors whose own is not known; they must stay where they are. Alone.
    void use_tiles(std::span<const SkyTile> tiles) { file_tiles_ = tiles; }
    // Null where none is known.
    [[nodiscard]] const SkyTile* tile(SectorId id) const;

  private:
    enum class SlotState : std::uint8_t { free, loaded, dropped };
    struct Slot {
        std::atomic<SlotState> state{SlotState::free};
        LoadedSector sector;
    };
    struct TileEntry {
        SkyTile tile;
        bool used = false;
    };
    using TableEntry = std::atomic<std::uint32_t>;  // 0 empty, else an index plus 1

    [[nodiscard]] std::uint32_t free_run(std::uint32_t length, std::uint32_t limit, bool interiors) const;
    void find_outdoor_probes(const LoadedSector& sector);
    void keep_tile(const SkyTile& tile);
    [[nodiscard]] TableEntry& tile_entry(SectorId id) const;

    SectorSetLimits limits_;
    std::span<Slot> slots_;
    std::span<TableEntry> slot_table_;
    std::span<TileEntry> tiles_;
    std::span<TableEntry> tile_table_;
    std::span<const SkyTile> file_tiles_;
    std::span<InteriorBounds> interior_bounds_;
    std::span<std::uint8_t> outdoor_probes_;
    std::uint64_t loads_ = 0;
};

// The sectors whose squares lie within `radius_m` of a camera, seen from above, nearest first, ties by (j,
// i): as many as there is room for. Gives how many it wrote. A camera that is not finite wants none; where a
// file can lie, SPEC.md says. Slide 24 of the talk: 51 sectors.
[[nodiscard]] std::size_t wanted_sectors(const Double3& camera_m, double radius_m, std::span<SectorId> out);

}  // namespace drtv
