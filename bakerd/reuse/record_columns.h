// Numbers of one kind, of many records, in a farm's record: byte by byte, so that like stands beside like.
#pragma once

#include "bakerd/reuse/record_bytes.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv::reuse {

// How a number relates to the one before it.
enum class Neighbours { alike, unrelated };

void add_column(RecordWriter& writer, std::span<const std::uint32_t> numbers, Neighbours neighbours);

[[nodiscard]] std::vector<std::uint32_t> read_column(RecordReader& reader,
                                                     std::size_t count,
                                                     Neighbours neighbours);

}  // namespace drtv::reuse
