// The probes that stand over ground.
#pragma once

#include "bakerd/picture/moment.h"
#include "format/kit/sector_folder.h"

#include <glm/vec3.hpp>

namespace drtv::picture {

// Calls use(place) for each.
template <class Use>
void for_each_ground_probe(const SectorSet& set, const Use& use) {
    kit::for_each_sector(set, [&](const LoadedSector& sector) {
        for (std::size_t p = 0; p < sector.view.probe_count; ++p) {
            if (sector.view.positions[p].kind == ProbeKind::ground)
                use(as_vec(position_m(sector.view, p)));
        }
    });
}

}  // namespace drtv::picture
