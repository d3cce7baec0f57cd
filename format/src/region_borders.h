// The rules for two sectors side by side: distances, sections and light at their border, and what one names
// of the other.
#pragma once

#include "region_findings.h"
#include "region_map.h"

namespace drtv {

void check_borders(const RegionMap& map, RegionFindings& findings);

}  // namespace drtv
