// What must hold inside a section, so that all that reads it stays inside it.
#include "bytes.h"
#include "interiors_content.h"
#include "local_transfer_content.h"
#include "section_refusal.h"
#include "sections.h"

#include <drtv/sector.h>

#include <cmath>
#include <cstdlib>

namespace drtv {
namespace {

ReadStatus check_finite(const Section& section, std::size_t at, const char* message) {
    return std::isfinite(load_f32(section.raw, at)) ? ReadStatus{} : refuse(section, at, message);
}

ReadStatus check_bake(const Section& section) {
    if (ReadStatus status = check_finite(section, 8, "bake section: the reach is not finite"); !status.ok())
        return status;
    return check_finite(section, 12, "bake section: the minimal distance is not finite");
}

ReadStatus check_positions(const Section& section, std::size_t probe_count) {
    for (std::size_t p = 0; p < probe_count; ++p) {
        const std::size_t kind_at = p * layout::position_bytes + 6;
        const std::size_t reserved_at = kind_at + 1;
        const std::uint8_t kind = section.raw[kind_at];
        if (kind > static_cast<std::uint8_t>(ProbeKind::manual))
            return refuse(section, kind_at, "probe ", p, ": kind ", kind, " is unknown");
        if (section.raw[reserved_at] != 0)
            return refuse(section, reserved_at, "probe ", p, ": its reserved byte is not zero");
    }
    return {};
}

ReadStatus check_grid(const Section& section) {
    const ByteSpan raw = section.raw;
    const std::int64_t z_origin = load_i32(raw, 0);
    if (std::abs(z_origin) > max_z_origin_units)
        return refuse(section, 0, "grid section: z origin ", z_origin, " is over the limit of 2^30");
    const auto cell_height = load_u32(raw, 4);
    if (cell_height == 0 || cell_height > max_cell_height_units) {
        return refuse(
            section, 4, "grid section: the cell height ", cell_height, " is not between 1 and 2^24");
    }
    if (load_u64(raw, 8) != 0)
        return refuse(section, 8, "grid section: reserved bytes are not zero");
    return {};
}

ReadStatus check_convergence(const Section& section) {
    for (std::size_t at = 0; at < 16; at += 4) {
        if (ReadStatus status = check_finite(section, at, "convergence section: an error is not finite");
            !status.ok())
            return status;
    }
    return {};
}

}  // namespace

ReadStatus check_content(SectionKind kind, const Section& section, std::size_t probe_count) {
    switch (kind) {
        case SectionKind::bake:
            return check_bake(section);
        case SectionKind::positions:
            return check_positions(section, probe_count);
        case SectionKind::grid:
            return check_grid(section);
        case SectionKind::statistics:
            return check_finite(section, 20, "statistics section: the used distance is not finite");
        case SectionKind::local_transfer:
            return check_local_transfer_content(section, probe_count);
        case SectionKind::convergence:
            return check_convergence(section);
        case SectionKind::interiors:
            return check_interiors_content(section, probe_count);
        case SectionKind::sky_visibility:
        case SectionKind::transfer:
        case SectionKind::static_irradiance:
            break;  // any codes can be read
    }
    return {};
}

}  // namespace drtv
