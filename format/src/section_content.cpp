// What must hold inside a section, so that all that reads it stays inside it.
#include "bytes.h"
#include "interiors_content.h"
#include "local_transfer_content.h"
#include "section_refusal.h"
#include "sections.h"

#include <drtv/sector.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace drtv {
namespace {

ReadStatus check_finite(const Section& section, std::size_t at, const char* message) {
    return std::isfinite(load_f32(section.raw, at)) ? ReadStatus{} : refuse(section, at, message);
}

ReadStatus check_bake(const Section& section) {
    if (ReadStatus status =
            check_finite(section, layout::bake::reach, "bake section: the reach is not finite");
        !status.ok())
        return status;
    return check_finite(
        section, layout::bake::min_distance, "bake section: the minimal distance is not finite");
}

ReadStatus check_positions(const Section& section, std::size_t probe_count) {
    for (std::size_t p = 0; p < probe_count; ++p) {
        const std::size_t kind_at = p * layout::position::bytes + layout::position::kind;
        const std::size_t reserved_at = p * layout::position::bytes + layout::position::reserved;
        const std::uint8_t kind = section.raw[kind_at];
        if (kind > static_cast<std::uint8_t>(ProbeKind::manual))
            return refuse(section, kind_at, "probe ", p, ": kind ", kind, " is unknown");
        if (section.raw[reserved_at] != 0)
            return refuse(section, reserved_at, "probe ", p, ": its reserved byte is not zero");
    }
    return {};
}

ReadStatus check_grid(const Section& section) {
    namespace at = layout::grid;
    const ByteSpan raw = section.raw;
    const std::int64_t z_origin = load_i32(raw, at::z_origin);
    if (std::abs(z_origin) > max_z_origin_units)
        return refuse(
            section, at::z_origin, "grid section: z origin ", z_origin, " is over the limit of 2^30");
    const auto cell_height = load_u32(raw, at::cell_height);
    if (cell_height == 0 || cell_height > max_cell_height_units) {
        return refuse(section,
                      at::cell_height,
                      "grid section: the cell height ",
                      cell_height,
                      " is not between 1 and 2^24");
    }
    if (load_u64(raw, at::reserved) != 0)
        return refuse(section, at::reserved, "grid section: reserved bytes are not zero");
    return {};
}

ReadStatus check_convergence(const Section& section) {
    namespace c = layout::convergence;
    for (const std::size_t at : {c::error_asked, c::error_median, c::error_p95, c::error_max}) {
        if (ReadStatus status = check_finite(section, at, "convergence section: an error is not finite");
            !status.ok())
            return status;
    }
    return {};
}

// A name, and zeros up to the end.
bool is_padded_name(ByteSpan bytes) {
    const auto end = std::find(bytes.begin(), bytes.end(), 0);
    return bytes.front() != 0 && end != bytes.end() && all_zero(ByteSpan(end, bytes.end()));
}

ReadStatus check_light_groups(const Section& section, std::size_t probe_count) {
    using Groups = layout::LightGroupsLayout;
    const ByteSpan raw = section.raw;
    const std::size_t groups = load_u16(raw, Groups::group_count);
    if (groups == 0 || groups > max_light_groups) {
        return refuse(section,
                      Groups::group_count,
                      "light groups section: ",
                      groups,
                      " groups, must be 1 to ",
                      max_light_groups);
    }
    if (!all_zero(raw.subspan(Groups::reserved, Groups::header_bytes - Groups::reserved)))
        return refuse(section, Groups::reserved, "light groups section: reserved bytes are not zero");
    const std::size_t bytes = Groups(probe_count, groups).end;
    if (raw.size() != bytes) {
        return refuse(section,
                      Groups::group_count,
                      "light groups section has ",
                      raw.size(),
                      " bytes, must have ",
                      bytes,
                      " for ",
                      groups,
                      " groups");
    }
    for (std::size_t g = 0; g < groups; ++g) {
        const std::size_t at = Groups::name_at(g);
        if (!is_padded_name(raw.subspan(at, Groups::name_bytes))) {
            return refuse(
                section, at, "light group ", g, ": its name is not 1 to 63 bytes with zeros behind them");
        }
    }
    return {};
}

ReadStatus check_probe_quality(const Section& section, std::size_t p) {
    using Layout = layout::QualityLayout;
    const std::size_t at = Layout::probe_at(p);
    for (std::size_t n = 0; n < Layout::error_count; ++n) {
        const std::size_t error_at = at + n * Layout::error_bytes;
        if (ReadStatus status = check_finite(section, error_at, "quality section: an error is not finite");
            !status.ok())
            return status;
    }
    constexpr unsigned known = Layout::budget_ended_bit | Layout::dark_bit | Layout::moved_bit;
    const unsigned flags = section.raw[at + Layout::flags];
    if ((flags & ~known) != 0)
        return refuse(section, at + Layout::flags, "quality of probe ", p, ": flags ", flags, " are unknown");
    const std::size_t reserved_at = at + Layout::probe_reserved;
    if (!all_zero(section.raw.subspan(reserved_at, Layout::probe_bytes - Layout::probe_reserved)))
        return refuse(section, reserved_at, "quality of probe ", p, ": its reserved bytes are not zero");
    return {};
}

ReadStatus check_quality(const Section& section, std::size_t probe_count) {
    using Layout = layout::QualityLayout;
    const ByteSpan raw = section.raw;
    const std::size_t groups = load_u16(raw, Layout::group_count);
    if (groups > max_light_groups) {
        return refuse(section,
                      Layout::group_count,
                      "quality section: ",
                      groups,
                      " light groups are over the limit of ",
                      max_light_groups);
    }
    if (!all_zero(raw.subspan(Layout::reserved, Layout::header_bytes - Layout::reserved)))
        return refuse(section, Layout::reserved, "quality section: reserved bytes are not zero");
    const Layout parts(probe_count, groups);
    if (raw.size() != parts.end) {
        return refuse(section,
                      Layout::group_count,
                      "quality section has ",
                      raw.size(),
                      " bytes, must have ",
                      parts.end,
                      " for ",
                      groups,
                      " light groups");
    }
    for (std::size_t p = 0; p < probe_count; ++p) {
        if (ReadStatus status = check_probe_quality(section, p); !status.ok())
            return status;
    }
    for (std::size_t at = parts.group_errors; at < parts.end; at += Layout::error_bytes) {
        if (ReadStatus status = check_finite(section, at, "quality section: a group's error is not finite");
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
            return check_finite(section,
                                layout::statistics::used_distance,
                                "statistics section: the used distance is not finite");
        case SectionKind::local_transfer:
            return check_local_transfer_content(section, probe_count);
        case SectionKind::convergence:
            return check_convergence(section);
        case SectionKind::interiors:
            return check_interiors_content(section, probe_count);
        case SectionKind::light_groups:
            return check_light_groups(section, probe_count);
        case SectionKind::quality:
            return check_quality(section, probe_count);
        case SectionKind::sky_visibility:
        case SectionKind::transfer:
        case SectionKind::static_irradiance:
            break;  // any codes can be read
    }
    return {};
}

}  // namespace drtv
