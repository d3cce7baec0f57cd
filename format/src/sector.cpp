#include <drtv/sector.h>

namespace drtv {

std::string_view name_of(ProbeKind kind) {
    switch (kind) {
        case ProbeKind::ground: return "ground";
        case ProbeKind::vegetation: return "vegetation";
        case ProbeKind::manual: return "manual";
    }
    return "unknown";
}

std::array<std::int32_t, 3> position_units(const Sector& sector, const Probe& probe) {
    constexpr std::int32_t side = sector_size_m * position_units_per_m;
    return {sector.i * side + probe.position[0], sector.j * side + probe.position[1],
            sector.z_origin_units + (std::int32_t{probe.position[2]} << sector.z_shift)};
}

Float3 position_m(const Sector& sector, const Probe& probe) {
    const auto units = position_units(sector, probe);
    return {static_cast<float>(units[0]) * position_unit_m, static_cast<float>(units[1]) * position_unit_m,
            static_cast<float>(units[2]) * position_unit_m};
}

}  // namespace drtv
