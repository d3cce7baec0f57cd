#include <drtv/sector.h>

#include "position.h"

namespace drtv {

std::string_view name_of(ProbeKind kind) {
    switch (kind) {
        case ProbeKind::ground:
            return "ground";
        case ProbeKind::vegetation:
            return "vegetation";
        case ProbeKind::manual:
            return "manual";
    }
    return "unknown";
}

std::array<std::int32_t, 3> position_units(const Sector& sector, const Probe& probe) {
    return units_of(sector, probe.position);
}

Float3 position_m(const Sector& sector, const Probe& probe) {
    return metres_of(position_units(sector, probe));
}

}  // namespace drtv
