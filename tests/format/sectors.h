// Sectors that tests write and read.
#pragma once

#include <drtv/sector.h>

#include <cstddef>
#include <cstdint>

namespace drtv::test {

// The two probes of tests/data/golden/format_1_0.drtv and of the example in format/SPEC.md. Frozen with them.
[[nodiscard]] Sector golden_sector();

// Valid, and else random in every field.
[[nodiscard]] Sector random_sector(std::uint32_t seed, std::size_t probe_count);

}  // namespace drtv::test
