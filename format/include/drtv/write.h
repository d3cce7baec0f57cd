// Writes a sector file. The same sector and options give the same bytes (with one version of zstd). Pure and
// thread-safe; costs about as much as reading.
//
//     const std::vector<std::uint8_t> bytes = drtv::write_sector(sector, {.codec = drtv::Codec::zstd});
#pragma once

#include <drtv/read.h>
#include <drtv/sector.h>

#include <cstdint>
#include <vector>

namespace drtv {

struct WriteOptions {
    Codec codec = Codec::raw;  // raw or zstd; zstd is used only for sections that it makes smaller,
                               // with local transfer filtered first
};

// The bytes of the file, in the lowest minor version that has all of the sector's sections. Values are
// written as they are: an invalid sector gives an invalid file.
// REQUIRES: at most 255 probes, |i| and |j| <= max_sector_coordinate, |z_origin_units| <= max_z_origin_units,
// z_shift <= max_z_shift; static irradiance empty or one per probe; local receivers one per probe, at most
// max_sector_sources local sources; at most max_light_groups light groups with names of 1 to
// max_light_group_name bytes other than 0, one irradiance per probe each; quality of each probe, and of each
// of at most max_light_groups groups its error at each probe; at most 1024 interiors, each of at most 65536
// vertices, all of at most 2^21 vertices and 2^18 triangles.
[[nodiscard]] std::vector<std::uint8_t> write_sector(const Sector& sector, const WriteOptions& options = {});

}  // namespace drtv
