// Files that the checks for people read. Each throws std::runtime_error with a sentence.
#pragma once

#include "bakerd/map/map.h"

#include <drtv/sector.h>

#include <filesystem>

namespace drtv::reference {

[[nodiscard]] map::Map read_map(const std::filesystem::path& path);
[[nodiscard]] Sector read_sector_file(const std::filesystem::path& path);

}  // namespace drtv::reference
