#include <drtv/view.h>

#include <drtv/write.h>

#include "bytes.h"
#include "sections.h"

namespace drtv {
namespace {

using Bytes = std::span<const std::uint8_t>;

// `count` elements that stand at `offset`, which the section's rules say are there. Types of this file have
// the layout of the bytes, offsets are multiples of their alignment.
template <class Element>
std::span<const Element> elements(Bytes raw, std::size_t offset, std::size_t count) {
    return {reinterpret_cast<const Element*>(raw.data() + offset), count};
}

void view_local_transfer(Bytes raw, std::size_t probe_count, SectorView& view) {
    using Local = layout::LocalTransferLayout;
    const std::size_t sources = load_le<std::uint16_t>(raw, Local::source_count),
                      pairs = load_le<std::uint32_t>(raw, Local::pair_count);
    const Local parts(probe_count, sources, pairs);
    view.local_sources = elements<LocalSource>(raw, Local::header_bytes, sources);
    view.local_receivers = elements<StoredReceiver>(raw, parts.receivers, probe_count);
    view.local_mask_bytes = Local::mask_bytes(sources);
    view.local_masks = raw.subspan(parts.masks, probe_count * view.local_mask_bytes);
    view.local_pairs = elements<LightCodes>(raw, parts.codes, pairs);
}

void view_interiors(Bytes raw, SectorView& view) {
    using Rooms = layout::InteriorsLayout;
    const std::size_t count = load_le<std::uint16_t>(raw, Rooms::interior_count),
                      vertices = load_le<std::uint32_t>(raw, Rooms::vertex_count),
                      triangles = load_le<std::uint32_t>(raw, Rooms::triangle_count);
    const Rooms parts(count, vertices, triangles);
    view.interiors = elements<StoredInterior>(raw, Rooms::header_bytes, count);
    view.interior_vertices = elements<std::array<std::uint16_t, 3>>(raw, parts.vertices, vertices);
    view.interior_triangles = elements<std::array<std::uint16_t, 3>>(raw, parts.triangles, triangles);
}

}  // namespace

ReadStatus open_sector(Bytes bytes, SectorView& view) {
    namespace h = layout::header;
    SectionTable table;
    Sections sections;
    if (ReadStatus status = load_sections(bytes, table, nullptr, sections); !status.ok())
        return status;
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % layout::alignment != 0) {
        return {ReadError::misaligned, 0, "the file's bytes do not start at a multiple of 16 in memory"};
    }
    const std::size_t count = sections.probe_count;
    SectorView v;
    v.i = load_i32(bytes, h::sector_i);
    v.j = load_i32(bytes, h::sector_j);
    v.z_origin_units = load_i32(bytes, h::z_origin);
    v.z_shift = bytes[h::z_shift];
    v.probe_count = count;
    v.positions = elements<StoredPosition>(sections.of(SectionKind::positions).raw, 0, count);
    v.sky_visibility = elements<VisibilityCodes>(sections.of(SectionKind::sky_visibility).raw, 0, count);
    v.transfer = elements<TransferCodes>(sections.of(SectionKind::transfer).raw, 0, count);
    v.grid = elements<StoredGrid>(sections.of(SectionKind::grid).raw, 0, 1).data();
    if (const Section& section = sections.of(SectionKind::static_irradiance); section.present) {
        v.static_irradiance = elements<LightCodes>(section.raw, 0, count);
        v.static_exponents = elements<std::int8_t>(section.raw, count * layout::light_codes_bytes, count);
    }
    if (const Section& section = sections.of(SectionKind::local_transfer); section.present)
        view_local_transfer(section.raw, count, v);
    if (const Section& section = sections.of(SectionKind::interiors); section.present)
        view_interiors(section.raw, v);
    view = v;
    return {};
}

ReadStatus unpack_sector(Bytes bytes, std::vector<std::uint8_t>& raw_file) {
    Sector sector;
    ReadStatus status = read_sector(bytes, sector);
    if (status.ok())
        raw_file = write_sector(sector);
    return status;
}

}  // namespace drtv
