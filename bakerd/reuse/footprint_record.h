// A footprint as the farm's store keeps it: a record beside each sector file.
#pragma once

#include "bakerd/reuse/footprint.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::reuse {

// Limit of an encoded record. One that would be larger has its smallest weights rounded up, which stays a
// safe bound, until it fits; if that cannot make it fit, it stays larger.
inline constexpr std::size_t max_record_bytes = std::size_t{16} << 10;
[[nodiscard]] std::vector<std::uint8_t> encode_footprint(const Footprint& footprint);
// Nothing when the bytes are not such.
[[nodiscard]] std::optional<Footprint> decode_footprint(std::span<const std::uint8_t> bytes);

}  // namespace drtv::reuse
