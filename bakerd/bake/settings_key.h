// What a bake's bytes follow from besides the map, as one key.
#pragma once

#include "bakerd/map/digest.h"
#include "settings/bake_settings.h"

#include <cstdint>

namespace drtv::bake {

// Raised whenever the same map and settings begin to give other bytes.
inline constexpr std::uint32_t baker_version = 6;

// Digest over the settings, format version, baker version and ISA class. Stored in every sector file.
[[nodiscard]] map::Digest settings_key(const settings::BakeSettings& settings);

}  // namespace drtv::bake
