// The validator's rules for the optional sections of format 1.1. Each does nothing where the sector has no such section.
#pragma once

#include <drtv/sector.h>

#include "findings.h"
#include "layout.h"

namespace drtv {

void check_static_irradiance(const Sector& sector, const layout::Place& place, Findings& findings);
void check_local_transfer(const Sector& sector, const layout::Place& place, Findings& findings);
void check_convergence(const Sector& sector, const layout::Place& place, Findings& findings);

}  // namespace drtv
