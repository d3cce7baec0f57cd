// Sectors that tests write and read.
#pragma once

#include <drtv/sector.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace drtv::test {

// The two probes of tests/data/golden/format_1_0.drtv and of the example in format/SPEC.md. Frozen with them.
[[nodiscard]] Sector golden_sector();

// The three probes of tests/data/golden/format_1_1.drtv, with all optional sections. Frozen with it.
[[nodiscard]] Sector golden_sector_1_1();

// Valid, and else random in every field.
[[nodiscard]] Sector random_sector(std::uint32_t seed, std::size_t probe_count);

// The same with all optional sections. With one probe at least: of no probes there is no static irradiance to write.
[[nodiscard]] Sector random_sector_1_1(std::uint32_t seed, std::size_t probe_count);

// The first probes of the sector to the east. REQUIRES: probes <= 255.
[[nodiscard]] std::vector<LocalSource> neighbouring_sources(std::size_t probes);

// Gives receiver `p` a pair with each of these sources. REQUIRES: those of `p` and all after it have none yet.
void add_pairs(LocalTransfer& local, std::size_t p, const std::vector<std::size_t>& sources, const LightCodes& codes);

}  // namespace drtv::test
