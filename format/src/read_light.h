// The optional sections of format 1.1: static irradiance, local transfer, convergence.
#pragma once

#include <drtv/read.h>

#include <span>

namespace drtv {

// Reads those of them that the file has, and that are of a version this reader knows. In a file of version 1.0 their
// kinds are unused: nothing is read. REQUIRES: `entries` is the file's table, `sector` has its probes.
ReadStatus read_light_sections(std::span<const std::uint8_t> file, std::span<const SectionEntry> entries, Sector& sector);

}  // namespace drtv
