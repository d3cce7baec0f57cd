// What sectors of one region owe each other: they tile a map without holes, were baked alike, and fit at
// their borders. Pure and thread-safe; costs some microseconds per sector, its own file not counted.
//
//     std::vector<drtv::RegionSector> sectors;                  // read_region_sector of each file
//     for (const drtv::RegionFinding& found : drtv::validate_region(sectors))
//     puts(found.finding.message.c_str());
#pragma once

#include <drtv/read.h>
#include <drtv/sector.h>
#include <drtv/validate.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv {

// What of a sector the others are held against: a few kilobytes, so that a whole world fits into memory.
struct RegionSector {
    std::int32_t i = 0, j = 0;
    // The sector that the file's name tells, where it has the form sector_<i>_<j>.drtv; set by the caller.
    std::optional<std::array<std::int32_t, 2>> named;

    BakeRecord bake;
    std::vector<std::array<std::int32_t, 3>> positions;  // world, units; exact to `position_step_units`
    std::vector<ProbeKind> kinds;
    std::int32_t position_step_units = 1;
    std::vector<std::array<float, basis_count * channel_count>>
        light;  // E/pi under a white sky of radiance 1, [b][c]
    std::vector<std::array<float, basis_count>> sky_visibility;
    Grid grid;
    bool has_local_transfer = false;
    std::vector<LocalSource> local_sources;
    std::uint64_t local_offset = 0;  // of the section in the file
    bool local_raw = true;
};

// REQUIRES for success: a file that can be read. On error `sector` is left as it was.
ReadStatus read_region_sector(std::span<const std::uint8_t> bytes, RegionSector& sector);

struct RegionFinding {
    std::size_t sector = 0;  // index into the sectors that were handed in
    Finding finding;
};

// Findings of the groups `borders` and `set`, by sector, then in the order of the table of issues. The order
// of `sectors` decides nothing but which of two files of one sector counts. Sectors `also_there` are (i, j)
// of files that cannot be read: no holes.
[[nodiscard]] std::vector<RegionFinding> validate_region(
    std::span<const RegionSector> sectors, std::span<const std::array<std::int32_t, 2>> also_there = {});

}  // namespace drtv
