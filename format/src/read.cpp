// From checked sections to a sector in memory. Long because it has a function or two for each kind of
// section.
#include <drtv/read.h>

#include "bytes.h"
#include "section_headers.h"
#include "section_table.h"
#include "sections.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace drtv {
namespace {

using Triples = std::vector<std::array<std::uint16_t, 3>>;
using Local = layout::LocalTransferLayout;

BakeRecord read_bake(ByteSpan raw) {
    namespace at = layout::bake;
    BakeRecord bake;
    bake.rays = load_u32(raw, at::rays);
    bake.bounces = load_u32(raw, at::bounces);
    bake.reach_m = load_f32(raw, at::reach);
    bake.min_distance_m = load_f32(raw, at::min_distance);
    std::memcpy(bake.settings_key.data(), raw.data() + at::settings_key, bake.settings_key.size());
    return bake;
}

void read_positions(ByteSpan raw, std::vector<Probe>& probes) {
    std::size_t at = 0;
    for (Probe& probe : probes) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            probe.position[axis] = load_u16(raw, at + layout::position::axes + 2 * axis);
        probe.kind = static_cast<ProbeKind>(raw[at + layout::position::kind]);
        at += layout::position::bytes;
    }
}

void read_sky_visibility(ByteSpan raw, std::vector<Probe>& probes) {
    std::size_t at = 0;
    for (Probe& probe : probes)
        at = load_codes(raw, at, probe.sky_visibility);
}

void read_transfer(ByteSpan raw, std::vector<Probe>& probes) {
    std::size_t at = 0;
    for (Probe& probe : probes)
        at = load_codes(raw, at, probe.transfer);
}

void read_grid(ByteSpan raw, Grid& grid) {
    grid.z_origin_units = load_i32(raw, layout::grid::z_origin);
    grid.cell_height_units = load_u32(raw, layout::grid::cell_height);
    std::memcpy(grid.cells.data(), raw.data() + layout::grid::cells, grid.cells.size());
}

Statistics read_statistics(ByteSpan raw) {
    namespace at = layout::statistics;
    Statistics s;
    s.candidates = load_u32(raw, at::candidates);
    s.moved_out = load_u32(raw, at::moved_out);
    s.dropped_in_solid = load_u32(raw, at::dropped_in_solid);
    s.removed_by_volume = load_u32(raw, at::removed_by_volume);
    s.thinned = load_u32(raw, at::thinned);
    s.used_distance_m = load_f32(raw, at::used_distance);
    s.rays = load_u64(raw, at::rays);
    s.back_hits = load_u64(raw, at::back_hits);
    return s;
}

void read_static_irradiance(ByteSpan raw, std::vector<StaticIrradiance>& probes) {
    std::size_t at = 0;
    for (StaticIrradiance& probe : probes)
        at = load_codes(raw, at, probe.codes);
    for (StaticIrradiance& probe : probes)
        probe.exponent = load_i8(raw, at++);
}

LocalSource read_local_source(ByteSpan raw, std::size_t at) {
    LocalSource source;
    source.di = load_i8(raw, at + Local::di);
    source.dj = load_i8(raw, at + Local::dj);
    source.probe = raw[at + Local::probe];
    source.exponent = load_i8(raw, at + Local::source_exponent);
    return source;
}

LocalReceiver read_local_receiver(ByteSpan raw, std::size_t at, ByteSpan mask) {
    LocalReceiver receiver;
    receiver.first_pair = load_u32(raw, at + Local::first_pair);
    receiver.exponent = load_i8(raw, at + Local::receiver_exponent);
    receiver.sources.assign(mask.begin(), mask.end());
    return receiver;
}

void read_local_transfer(ByteSpan raw, std::size_t probe_count, LocalTransfer& local) {
    const LocalTransferCounts counts = load_local_transfer_counts(raw);
    const Local parts = counts.parts(probe_count);
    const std::size_t mask_bytes = local_mask_bytes(counts.sources);
    local.sources.reserve(counts.sources);
    for (std::size_t s = 0; s < counts.sources; ++s)
        local.sources.push_back(read_local_source(raw, Local::source_at(s)));
    local.receivers.reserve(probe_count);
    for (std::size_t p = 0; p < probe_count; ++p) {
        const ByteSpan mask = raw.subspan(parts.masks + p * mask_bytes, mask_bytes);
        local.receivers.push_back(read_local_receiver(raw, parts.receiver_at(p), mask));
    }
    local.pairs.resize(counts.pairs);
    std::size_t at = parts.codes;
    for (LightCodes& pair : local.pairs)
        at = load_codes(raw, at, pair);
}

Convergence read_convergence(ByteSpan raw) {
    namespace at = layout::convergence;
    Convergence c;
    c.error_asked = load_f32(raw, at::error_asked);
    c.error_median = load_f32(raw, at::error_median);
    c.error_p95 = load_f32(raw, at::error_p95);
    c.error_max = load_f32(raw, at::error_max);
    c.paths_least = load_u32(raw, at::paths_least);
    c.paths_most = load_u32(raw, at::paths_most);
    c.local_bounces = load_u32(raw, at::local_bounces);
    c.local_rays = load_u32(raw, at::local_rays);
    c.static_rays = load_u64(raw, at::static_rays);
    c.local_transfer_rays = load_u64(raw, at::local_transfer_rays);
    return c;
}

// Gives the offset behind the last.
std::size_t read_triples(ByteSpan raw, std::size_t at, Triples& triples) {
    for (auto& triple : triples) {
        for (std::uint16_t& value : triple) {
            value = load_u16(raw, at);
            at += sizeof value;
        }
    }
    return at;
}

void read_interiors(ByteSpan raw, std::vector<Interior>& interiors) {
    using Rooms = layout::InteriorsLayout;
    const InteriorsCounts counts = load_interiors_counts(raw);
    const Rooms parts = counts.parts();
    std::size_t vertex_at = parts.vertices;
    std::size_t triangle_at = parts.triangles;
    interiors.resize(counts.interiors);
    for (std::size_t n = 0; n < counts.interiors; ++n) {
        const ByteSpan entry = raw.subspan(Rooms::entry_at(n), Rooms::entry_bytes);
        Interior& interior = interiors[n];
        for (std::size_t axis = 0; axis < 3; ++axis)
            interior.origin_units[axis] = load_i32(entry, Rooms::origin + 4 * axis);
        interior.shift = entry[Rooms::shift];
        interior.probe = entry[Rooms::probe];
        interior.vertices.resize(load_u32(entry, Rooms::vertices_of));
        interior.triangles.resize(load_u32(entry, Rooms::triangles_of));
        vertex_at = read_triples(raw, vertex_at, interior.vertices);
        triangle_at = read_triples(raw, triangle_at, interior.triangles);
    }
}

std::string read_name(ByteSpan padded) {
    return {padded.begin(), std::ranges::find(padded, 0)};
}

void read_light_groups(ByteSpan raw, std::size_t probe_count, std::vector<LightGroup>& groups) {
    using Groups = layout::LightGroupsLayout;
    groups.resize(load_u16(raw, Groups::group_count));
    const Groups parts(probe_count, groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        groups[g].name = read_name(raw.subspan(Groups::name_at(g), Groups::name_bytes));
        groups[g].irradiance.resize(probe_count);
        for (std::size_t p = 0; p < probe_count; ++p) {
            StaticIrradiance& light = groups[g].irradiance[p];
            load_codes(raw, parts.codes_at(g, p), light.codes);
            light.exponent = load_i8(raw, parts.exponent_at(g, p));
        }
    }
}

ProbeQuality read_probe_quality(ByteSpan entry) {
    using Layout = layout::QualityLayout;
    ProbeQuality probe;
    probe.transfer_error = load_f32(entry, Layout::transfer_error);
    probe.visibility_error = load_f32(entry, Layout::visibility_error);
    probe.static_error = load_f32(entry, Layout::static_error);
    probe.paths = load_u32(entry, Layout::paths);
    probe.back_hits = load_u32(entry, Layout::back_hits);
    const unsigned flags = entry[Layout::flags];
    probe.budget_ended = (flags & Layout::budget_ended_bit) != 0;
    probe.dark = (flags & Layout::dark_bit) != 0;
    probe.moved = (flags & Layout::moved_bit) != 0;
    return probe;
}

Quality read_quality(ByteSpan raw, std::size_t probe_count) {
    using Layout = layout::QualityLayout;
    Quality quality;
    quality.buried_cells = load_u32(raw, Layout::buried_cells);
    quality.blind_cells = load_u32(raw, Layout::blind_cells);
    quality.group_errors.resize(load_u16(raw, Layout::group_count));
    for (std::size_t p = 0; p < probe_count; ++p)
        quality.probes.push_back(read_probe_quality(raw.subspan(Layout::probe_at(p), Layout::probe_bytes)));
    const Layout parts(probe_count, quality.group_errors.size());
    for (std::size_t g = 0; g < quality.group_errors.size(); ++g) {
        for (std::size_t p = 0; p < probe_count; ++p)
            quality.group_errors[g].push_back(load_f32(raw, parts.group_error_at(g, p)));
    }
    return quality;
}

}  // namespace

void copy_sector(ByteSpan file, const Sections& sections, Sector& sector) {
    namespace h = layout::header;
    const std::size_t probe_count = sections.probe_count;
    sector.i = load_i32(file, h::sector_i);
    sector.j = load_i32(file, h::sector_j);
    sector.z_origin_units = load_i32(file, h::z_origin);
    sector.z_shift = file[h::z_shift];
    sector.probes.resize(probe_count);
    sector.bake = read_bake(sections.raw(SectionKind::bake));
    read_positions(sections.raw(SectionKind::positions), sector.probes);
    read_sky_visibility(sections.raw(SectionKind::sky_visibility), sector.probes);
    read_transfer(sections.raw(SectionKind::transfer), sector.probes);
    read_grid(sections.raw(SectionKind::grid), sector.grid);
    sector.statistics = read_statistics(sections.raw(SectionKind::statistics));
    if (sections.has(SectionKind::static_irradiance)) {
        sector.static_irradiance.resize(probe_count);
        read_static_irradiance(sections.raw(SectionKind::static_irradiance), sector.static_irradiance);
    }
    if (sections.has(SectionKind::local_transfer)) {
        LocalTransfer& local = sector.local_transfer.emplace();
        read_local_transfer(sections.raw(SectionKind::local_transfer), probe_count, local);
    }
    if (sections.has(SectionKind::convergence))
        sector.convergence = read_convergence(sections.raw(SectionKind::convergence));
    if (sections.has(SectionKind::interiors))
        read_interiors(sections.raw(SectionKind::interiors), sector.interiors);
    if (sections.has(SectionKind::light_groups))
        read_light_groups(sections.raw(SectionKind::light_groups), probe_count, sector.light_groups);
    if (sections.has(SectionKind::quality))
        sector.quality = read_quality(sections.raw(SectionKind::quality), probe_count);
}

ReadStatus read_section_table(ByteSpan bytes, std::vector<SectionEntry>& entries) {
    entries.clear();
    SectionTable table;
    ReadStatus status = load_section_table(bytes, table);
    if (status.ok())
        entries.assign(table.entries.begin(),
                       table.entries.begin() + static_cast<std::ptrdiff_t>(table.count));
    return status;
}

ReadStatus read_sector(ByteSpan bytes, Sector& sector) {
    SectionTable table;
    Unpacking unpacking{unpack_section};
    Sections sections;
    if (ReadStatus status = load_sections(bytes, table, &unpacking, sections); !status.ok())
        return status;
    Sector read;
    copy_sector(bytes, sections, read);
    sector = std::move(read);
    return {};
}

}  // namespace drtv
