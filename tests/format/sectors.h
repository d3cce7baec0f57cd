// Sectors that tests write and read.
#pragma once

#include <drtv/sector.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace drtv::test {

// The two probes of tests/data/golden/format_1_0.drtv and of the example in format/SPEC.md. Frozen with them.
[[nodiscard]] Sector golden_sector();

// The three probes of tests/data/golden/format_1_1.drtv, with all optional sections. Frozen with it.
[[nodiscard]] Sector golden_sector_1_1();

// The same with two interiors, as in tests/data/golden/format_1_2.drtv. Frozen with it.
[[nodiscard]] Sector golden_sector_1_2();

// The same with light groups and quality, and with more local sources than a section of version 1 may name,
// as in tests/data/golden/format_1_3.drtv. Frozen with it.
[[nodiscard]] Sector golden_sector_1_3();

// A closed box between two corners, in steps of 2^shift units from the origin. Fronts outwards.
[[nodiscard]] Interior box_interior(const std::array<std::int32_t, 3>& origin_units,
                                    const std::array<std::uint16_t, 3>& low,
                                    const std::array<std::uint16_t, 3>& high);

// Valid, and else random in every field.
[[nodiscard]] Sector random_sector(std::uint32_t seed, std::size_t probe_count);

// The same with all optional sections. With one probe at least: of no probes there is no static irradiance to
// write.
[[nodiscard]] Sector random_sector_1_1(std::uint32_t seed, std::size_t probe_count);

// The same with interiors, unless it has no probes.
[[nodiscard]] Sector random_sector_1_2(std::uint32_t seed, std::size_t probe_count);

// The same with light groups and quality, and up to all local sources that a sector may have.
[[nodiscard]] Sector random_sector_1_3(std::uint32_t seed, std::size_t probe_count);

// Each cell names one of the 4 probes nearest to its centre: the one that `choose`, asked with how many there
// are, gives the rank of.
void fill_grid(Sector& sector, const std::function<std::size_t(std::size_t)>& choose);

// The first probes of the sector to the east, then of the others around it. REQUIRES: probes <= 2040.
[[nodiscard]] std::vector<LocalSource> neighbouring_sources(std::size_t probes);

// Gives receiver `p` a pair with each of these sources. REQUIRES: those of `p` and all after it have none
// yet.
void add_pairs(LocalTransfer& local, std::size_t p, const std::vector<std::size_t>& sources,
               const LightCodes& codes);

}  // namespace drtv::test
