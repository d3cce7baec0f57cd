// Checks the sectors of a region against each other: they cover the map without holes, were baked alike, and
// agree at their borders. Pure and thread-safe; costs some microseconds per sector, reading its file not
// included.
//
//     std::vector<drtv::RegionSector> sectors;                  // read_region_sector of each file
//     for (const drtv::RegionFinding& found : drtv::validate_region(sectors))
//         puts(found.finding.message.c_str());
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

// The part of a sector that is compared with others: a few kilobytes, so that a whole world fits into memory.
struct RegionSector {
    std::int32_t i = 0, j = 0;
    // The sector in the file's name, where the name has the form sector_<i>_<j>.drtv; set by the caller.
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

// Reads `sector` from a file's bytes. REQUIRES for success: a file that can be read. On error `sector` is
// left as it was.
ReadStatus read_region_sector(std::span<const std::uint8_t> bytes, RegionSector& sector);

struct RegionFinding {
    std::size_t sector = 0;  // index into the sectors that were passed
    Finding finding;
};

// Findings of the groups `borders` and `set`, by sector, then in the order of the table of issues. The order
// of `sectors` matters only where two files hold one sector: it decides which of them counts. `also_there`
// are the (i, j) of files that cannot be read, which therefore are not holes.
[[nodiscard]] std::vector<RegionFinding> validate_region(
    std::span<const RegionSector> sectors, std::span<const std::array<std::int32_t, 2>> also_there = {});

}  // namespace drtv
