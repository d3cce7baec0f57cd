// Lines of `drtv info` that a file and a folder share, without their labels.
#pragma once

#include <drtv/sector.h>

#include <string>

namespace drtv::tool {

[[nodiscard]] std::string settings_text(const BakeRecord& bake);
[[nodiscard]] std::string placement_text(const Statistics& statistics);
[[nodiscard]] std::string rays_text(const Statistics& statistics);

}  // namespace drtv::tool
