#include <drtv/view.h>

#include "bytes.h"
#include "section_headers.h"
#include "sections.h"

namespace drtv {
namespace {

using Triple = std::array<std::uint16_t, 3>;

// `count` elements that stand at `offset`, which the section's rules say are there. Types of this file have
// the layout of the bytes, offsets are multiples of their alignment.
template <class Element>
std::span<const Element> elements(ByteSpan raw, std::size_t offset, std::size_t count) {
    return {reinterpret_cast<const Element*>(raw.data() + offset), count};
}

void view_static_irradiance(ByteSpan raw, std::size_t probe_count, SectorView& view) {
    const std::size_t exponents = probe_count * layout::light_codes_bytes;
    view.static_irradiance = elements<LightCodes>(raw, 0, probe_count);
    view.static_exponents = elements<std::int8_t>(raw, exponents, probe_count);
}

void view_local_transfer(ByteSpan raw, std::size_t probe_count, SectorView& view) {
    using LocalAt = layout::LocalTransferLayout;
    const auto [sources, pairs] = load_local_transfer_counts(raw);
    const LocalAt parts(probe_count, sources, pairs);
    const std::size_t mask_bytes = local_mask_bytes(sources);
    view.local_sources = elements<LocalSource>(raw, LocalAt::header_bytes, sources);
    view.local_receivers = elements<StoredReceiver>(raw, parts.receivers, probe_count);
    view.local_mask_bytes = mask_bytes;
    view.local_masks = raw.subspan(parts.masks, probe_count * mask_bytes);
    view.local_pairs = elements<LightCodes>(raw, parts.codes, pairs);
}

void view_interiors(ByteSpan raw, SectorView& view) {
    using RoomsAt = layout::InteriorsLayout;
    const auto [interiors, vertices, triangles] = load_interiors_counts(raw);
    const RoomsAt parts(interiors, vertices, triangles);
    view.interiors = elements<StoredInterior>(raw, RoomsAt::header_bytes, interiors);
    view.interior_vertices = elements<Triple>(raw, parts.vertices, vertices);
    view.interior_triangles = elements<Triple>(raw, parts.triangles, triangles);
}

void view_light_groups(ByteSpan raw, std::size_t probe_count, SectorView& view) {
    using GroupsAt = layout::LightGroupsLayout;
    const std::size_t groups = load_u16(raw, GroupsAt::group_count);
    const GroupsAt parts(probe_count, groups);
    view.light_group_names = elements<StoredName>(raw, GroupsAt::header_bytes, groups);
    view.light_group_irradiance = elements<LightCodes>(raw, parts.codes, groups * probe_count);
    view.light_group_exponents = elements<std::int8_t>(raw, parts.exponents, groups * probe_count);
}

SectorView view_sections(ByteSpan file, const Sections& sections) {
    namespace h = layout::header;
    const std::size_t count = sections.probe_count;
    SectorView view;
    view.i = load_i32(file, h::sector_i);
    view.j = load_i32(file, h::sector_j);
    view.z_origin_units = load_i32(file, h::z_origin);
    view.z_shift = file[h::z_shift];
    view.probe_count = count;
    view.positions = elements<StoredPosition>(sections.raw(SectionKind::positions), 0, count);
    view.sky_visibility = elements<VisibilityCodes>(sections.raw(SectionKind::sky_visibility), 0, count);
    view.transfer = elements<TransferCodes>(sections.raw(SectionKind::transfer), 0, count);
    view.grid = elements<StoredGrid>(sections.raw(SectionKind::grid), 0, 1).data();
    if (sections.has(SectionKind::static_irradiance))
        view_static_irradiance(sections.raw(SectionKind::static_irradiance), count, view);
    if (sections.has(SectionKind::local_transfer))
        view_local_transfer(sections.raw(SectionKind::local_transfer), count, view);
    if (sections.has(SectionKind::interiors))
        view_interiors(sections.raw(SectionKind::interiors), view);
    if (sections.has(SectionKind::light_groups))
        view_light_groups(sections.raw(SectionKind::light_groups), count, view);
    return view;
}

}  // namespace

ReadStatus open_sector(ByteSpan bytes, SectorView& view) {
    SectionTable table;
    Sections sections;
    if (ReadStatus status = load_sections(bytes, table, nullptr, sections); !status.ok())
        return status;
    const auto address = reinterpret_cast<std::uintptr_t>(bytes.data());
    if (address % layout::alignment != 0) {
        return {ReadError::misaligned, 0, "the file's bytes do not start at a multiple of 16 in memory"};
    }
    view = view_sections(bytes, sections);
    return {};
}

}  // namespace drtv
