// The validator's rules, a function a section. Each does nothing where the sector has no such section.
#pragma once

#include <drtv/sector.h>

#include "findings.h"
#include "layout.h"

namespace drtv {

struct SectionCheck {
    const Sector& sector;
    layout::Place place;  // of the section that the rules are about
    Findings& findings;
};

void check_settings(const SectionCheck& check);
void check_probe_positions(const SectionCheck& check);
void check_sky_visibility(const SectionCheck& check);
void check_transfer(const SectionCheck& check);
void check_grid(const SectionCheck& check);
void check_static_irradiance(const SectionCheck& check);
void check_local_transfer(const SectionCheck& check);
void check_convergence(const SectionCheck& check);
void check_interiors(const SectionCheck& check);
void check_light_groups(const SectionCheck& check);
void check_quality(const SectionCheck& check);

}  // namespace drtv
