// A baked sector's file.
#pragma once

#include <drtv/sector.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::bake {

// The bytes of the file, checked by the validator; a sentence with the first error when it fails. What the
// validator warns of is added to `warnings`.
[[nodiscard]] tl::expected<std::vector<std::uint8_t>, std::string> encode_sector(
    const Sector& sector, std::vector<std::string>& warnings);

// The sector of a file; nothing when it cannot be read.
[[nodiscard]] std::optional<Sector> decode_sector(std::span<const std::uint8_t> bytes);

}  // namespace drtv::bake
