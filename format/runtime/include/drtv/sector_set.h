// The sectors that a game has in memory: used in place, loaded and dropped in any order, and asked for the
// probes that light a place. Any number of cameras and volumes (drtv/volume.h) may use one set.
//
// Memory: one block of the caller's; nothing is allocated after that. The files' bytes are the caller's too,
// and must stay in place until `retire` after `drop`.
//
// Threads: const calls may run on any number of threads, beside one thread that loads and drops. `retire`
// runs alone: a game calls it once per frame, while no other call is under way. A dropped sector is gone for
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
    std::uint32_t probes = 64 * max_probes;  // of all sectors together; each takes one run without gaps
    std::uint32_t interiors = 256;           // likewise
    std::uint32_t tiles = 4096;              // kept for sectors that are or were loaded
};

struct SectorId {
    std::int32_t i = 0;
    std::int32_t j = 0;

    bool operator==(const SectorId&) const = default;
};

enum class LoadStatus : std::uint8_t {
    loaded,
    unreadable,     // open_sector refused the file
    already_there,  // the set has this sector; a dropped one counts until `retire`
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

// A loaded sector. Its probe p has the number first_probe + p among the probes of all sectors, below
// SectorSetLimits::probes, from load to retire.
struct LoadedSector {
    SectorView view;
    std::uint32_t slot = 0;  // below SectorSetLimits::sectors
    std::uint32_t first_probe = 0;
    std::uint32_t first_interior = 0;
    std::uint64_t load = 0;  // counts loads from 1; earlier sectors of the slot had others
};

struct ProbeShare {
    const LoadedSector* sector = nullptr;
    std::uint8_t probe = 0;
    float share = 0;
};

// The shares and that of the fallback, an open sky without ground, add up to 1.
struct ProbeBlend {
    std::array<ProbeShare, 8> probes{};
    std::size_t count = 0;
    float fallback = 0;
    PlaceStatus status = PlaceStatus::sector_missing;
};

// An interior that holds a place, or is near it.
struct InteriorShare {
    const LoadedSector* sector = nullptr;  // null: none
    std::uint32_t index = 0;               // of sector->view.interiors
    float share = 0;                       // of its probe; the rest goes to what lights the place outside
};

class SectorSet {
  public:
    // Bytes of memory that a set needs. The memory must start at a multiple of 16.
    [[nodiscard]] static std::size_t memory_bytes(const SectorSetLimits& limits);

    // REQUIRES: memory.size() >= memory_bytes(limits), it starts at a multiple of 16, and lives as long as
    // this.
    SectorSet(std::span<std::byte> memory, const SectorSetLimits& limits);
    SectorSet(const SectorSet&) = delete;
    SectorSet& operator=(const SectorSet&) = delete;

    // Opens a raw sector file and makes its tile. Where they are given, `why` gets the status of open_sector
    // and `loaded` the sector. Cost: some 20 us for 15 KB, most of it
    // for the tile, and one is_inside for each probe within the bounds of an interior.
    LoadStatus load(std::span<const std::uint8_t> file,
                    const LoadedSector** loaded = nullptr,
                    ReadStatus* why = nullptr);
    // False where the sector is not there. Its tile is kept.
    bool drop(SectorId id);
    // Frees the room of dropped sectors. Alone: no other call may be under way.
    void retire();

    // Null where it is not loaded.
    [[nodiscard]] const LoadedSector* find(SectorId id) const;
    // The sector in a slot; null where the slot has none. REQUIRES: slot < limits().sectors.
    [[nodiscard]] const LoadedSector* at(std::uint32_t slot) const;
    [[nodiscard]] const SectorSetLimits& limits() const { return limits_; }

    // The probe that the grid of the place's sector names (slide 54). One share, or the fallback.
    [[nodiscard]] ProbeBlend nearest(const Double3& world_m) const;
    // Blends the eight cells around the place, continuously across sectors and holes: first the two cells of
    // each column, then the four columns.
    [[nodiscard]] ProbeBlend trilinear(const Double3& world_m) const;

    // The interior with the largest share. The share is clamp(1/2 + d / soft_m, 0, 1), where d is the
    // distance to its mesh in metres, below 0 outside; with a softness of 0 it is 1 inside and 0 outside.
    // Ties go to the place's own sector, then to the nearest sector (by its centre, j, i), then to the first
    // in the file.
    [[nodiscard]] InteriorShare interior(const Double3& world_m, float soft_m = 1) const;

    // For each probe of a sector, the probe that stands for it outdoors. A probe that is inside an interior
    // of its sector, or that such an interior names, does not light what is outside: the nearest probe that
    // is not indoors in this way does (ties go to the first). All others stand for themselves, and so do all
    // where every probe is indoors. REQUIRES, also below: sectors of this set.
    [[nodiscard]] std::span<const std::uint8_t> outdoor_probes(const LoadedSector& sector) const {
        return outdoor_probes_.subspan(sector.first_probe, sector.view.probe_count);
    }
    // A blend with these probes: what lights a place that is in no interior.
    [[nodiscard]] ProbeBlend outdoors(const ProbeBlend& blend) const;

    // What is left of the open sky's ambient light (drtv/sky_tile.h), 0 to 1, blended from the four nearest
    // columns; 1 in sectors without a tile.
    [[nodiscard]] float sky_factor(const Double3& world_m) const;

    // Sets the tiles of a file (open_tiles), for sectors whose own tile is not known. They must stay in
    // place. Alone.
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
// i): as many as there is room for. Returns how many it wrote: none for a camera that is not finite. Leaves
// out sectors that no file can be for (SPEC.md, section 4.1). The talk has 51 sectors (slide 24).
[[nodiscard]] std::size_t wanted_sectors(const Double3& camera_m, double radius_m, std::span<SectorId> out);

}  // namespace drtv
