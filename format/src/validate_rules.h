// The validator's rules, a function a section. Each does nothing where the sector has no such section.
#pragma once

#include <drtv/sector.h>

#include "findings.h"
#include "layout.h"

namespace drtv {

void check_settings(const Sector& sector, const layout::Place& place, Findings& findings);
void check_probe_positions(const Sector& sector, const layout::Place& place, Findings& findings);
void check_sky_visibility(const Sector& sector, const layout::Place& place, Findings& findings);
void check_transfer(const Sector& sector, const layout::Place& place, Findings& findings);
void check_grid(const Sector& sector, const layout::Place& place, Findings& findings);
void check_static_irradiance(const Sector& sector, const layout::Place& place, Findings& findings);
void check_local_transfer(const Sector& sector, const layout::Place& place, Findings& findings);
void check_convergence(const Sector& sector, const layout::Place& place, Findings& findings);
void check_interiors(const Sector& sector, const layout::Place& place, Findings& findings);

}  // namespace drtv
