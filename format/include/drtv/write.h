// Writing a sector file: the same sector and options give the same bytes (with one version of zstd).
#pragma once

#include <drtv/read.h>
#include <drtv/sector.h>

#include <cstdint>
#include <vector>

namespace drtv {

struct WriteOptions {
    Codec codec = Codec::raw;  // zstd is used for a section only where it makes it smaller
};

// The bytes of the file. Values are written as they are: what is not a valid sector gives a file that is not valid.
// REQUIRES: at most 255 probes, |i| and |j| <= max_sector_coordinate, |z_origin_units| <= max_z_origin_units,
// z_shift <= max_z_shift.
[[nodiscard]] std::vector<std::uint8_t> write_sector(const Sector& sector, const WriteOptions& options = {});

}  // namespace drtv
