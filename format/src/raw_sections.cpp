// Long because it has a function or two for each kind of section.
#include "raw_sections.h"

#include "bytes.h"
#include "layout.h"
#include "section_headers.h"

#include <array>

namespace drtv {
namespace {

using Triples = std::vector<std::array<std::uint16_t, 3>>;

ByteVector bake_section(const BakeRecord& bake) {
    ByteVector bytes;
    append_le(bytes, bake.rays);
    append_le(bytes, bake.bounces);
    append_f32(bytes, bake.reach_m);
    append_f32(bytes, bake.min_distance_m);
    append_bytes(bytes, bake.settings_key);
    return bytes;
}

ByteVector positions_section(const std::vector<Probe>& probes) {
    ByteVector bytes;
    for (const Probe& probe : probes) {
        for (std::uint16_t axis : probe.position)
            append_le(bytes, axis);
        bytes.push_back(static_cast<std::uint8_t>(probe.kind));
        append_zeros(bytes, 1);
    }
    return bytes;
}

ByteVector sky_visibility_section(const std::vector<Probe>& probes) {
    ByteVector bytes;
    for (const Probe& probe : probes)
        append_codes(bytes, probe.sky_visibility);
    return bytes;
}

ByteVector transfer_section(const std::vector<Probe>& probes) {
    ByteVector bytes;
    for (const Probe& probe : probes)
        append_codes(bytes, probe.transfer);
    return bytes;
}

ByteVector grid_section(const Grid& grid) {
    ByteVector bytes;
    append_le(bytes, grid.z_origin_units);
    append_le(bytes, grid.cell_height_units);
    append_zeros(bytes, 8);
    append_bytes(bytes, grid.cells);
    return bytes;
}

ByteVector statistics_section(const Statistics& s) {
    ByteVector bytes;
    append_le(bytes, s.candidates);
    append_le(bytes, s.moved_out);
    append_le(bytes, s.dropped_in_solid);
    append_le(bytes, s.removed_by_volume);
    append_le(bytes, s.thinned);
    append_f32(bytes, s.used_distance_m);
    append_le(bytes, s.rays);
    append_le(bytes, s.back_hits);
    return bytes;
}

ByteVector static_irradiance_section(const std::vector<StaticIrradiance>& probes) {
    ByteVector bytes;
    for (const StaticIrradiance& probe : probes)
        append_codes(bytes, probe.codes);
    for (const StaticIrradiance& probe : probes)
        append_le(bytes, probe.exponent);
    return bytes;
}

void append_source(ByteVector& bytes, const LocalSource& source) {
    append_le(bytes, source.di);
    append_le(bytes, source.dj);
    append_le(bytes, source.probe);
    append_le(bytes, source.exponent);
}

void append_receiver(ByteVector& bytes, const LocalReceiver& receiver) {
    append_le(bytes, receiver.first_pair);
    append_le(bytes, receiver.exponent);
    append_zeros(bytes, 3);
}

// With zeros behind them, `size` bytes in all.
void append_padded(ByteVector& bytes, const auto& content, std::size_t size) {
    for (const auto byte : content)
        bytes.push_back(static_cast<std::uint8_t>(byte));
    append_zeros(bytes, size - content.size());
}

ByteVector local_transfer_section(const LocalTransfer& local) {
    const LocalTransferCounts counts{local.sources.size(), local.pairs.size()};
    const layout::LocalTransferLayout parts = counts.parts(local.receivers.size());
    ByteVector bytes;
    bytes.reserve(parts.end);
    append_u16(bytes, counts.sources);
    append_u16(bytes, local_mask_bytes(counts.sources));
    append_u32(bytes, counts.pairs);
    append_zeros(bytes, 8);
    for (const LocalSource& source : local.sources)
        append_source(bytes, source);
    bytes.resize(parts.receivers, 0);
    for (const LocalReceiver& receiver : local.receivers)
        append_receiver(bytes, receiver);
    bytes.resize(parts.masks, 0);
    for (const LocalReceiver& receiver : local.receivers)
        append_padded(bytes, receiver.sources, local_mask_bytes(counts.sources));
    for (const LightCodes& pair : local.pairs)
        append_codes(bytes, pair);
    return bytes;
}

ByteVector convergence_section(const Convergence& c) {
    ByteVector bytes;
    append_f32(bytes, c.error_asked);
    append_f32(bytes, c.error_median);
    append_f32(bytes, c.error_p95);
    append_f32(bytes, c.error_max);
    append_le(bytes, c.paths_least);
    append_le(bytes, c.paths_most);
    append_le(bytes, c.local_bounces);
    append_le(bytes, c.local_rays);
    append_le(bytes, c.static_rays);
    append_le(bytes, c.local_transfer_rays);
    return bytes;
}

InteriorsCounts counts_of(const std::vector<Interior>& interiors) {
    InteriorsCounts counts{interiors.size(), 0, 0};
    for (const Interior& interior : interiors) {
        counts.vertices += interior.vertices.size();
        counts.triangles += interior.triangles.size();
    }
    return counts;
}

// Lines of the table; each interior's vertices and triangles begin behind those of the ones before.
void append_entries(ByteVector& bytes, const std::vector<Interior>& interiors) {
    std::size_t first_vertex = 0;
    std::size_t first_triangle = 0;
    for (const Interior& interior : interiors) {
        for (const std::int32_t origin : interior.origin_units)
            append_le(bytes, origin);
        append_le(bytes, interior.shift);
        append_le(bytes, interior.probe);
        append_zeros(bytes, 2);
        append_u32(bytes, first_vertex);
        append_u32(bytes, interior.vertices.size());
        append_u32(bytes, first_triangle);
        append_u32(bytes, interior.triangles.size());
        first_vertex += interior.vertices.size();
        first_triangle += interior.triangles.size();
    }
}

void append_triples(ByteVector& bytes, const Triples& triples) {
    for (const auto& triple : triples) {
        for (const std::uint16_t value : triple)
            append_le(bytes, value);
    }
}

ByteVector interiors_section(const std::vector<Interior>& interiors) {
    const InteriorsCounts counts = counts_of(interiors);
    const layout::InteriorsLayout parts = counts.parts();
    ByteVector bytes;
    bytes.reserve(parts.end);
    append_u16(bytes, counts.interiors);
    append_zeros(bytes, 2);
    append_u32(bytes, counts.vertices);
    append_u32(bytes, counts.triangles);
    append_zeros(bytes, 4);
    append_entries(bytes, interiors);
    for (const Interior& interior : interiors)
        append_triples(bytes, interior.vertices);
    bytes.resize(parts.triangles, 0);
    for (const Interior& interior : interiors)
        append_triples(bytes, interior.triangles);
    return bytes;
}

ByteVector light_groups_section(const std::vector<LightGroup>& groups) {
    using Groups = layout::LightGroupsLayout;
    ByteVector bytes;
    append_u16(bytes, groups.size());
    append_zeros(bytes, Groups::header_bytes - Groups::reserved);
    for (const LightGroup& group : groups)
        append_padded(bytes, group.name, Groups::name_bytes);
    for (const LightGroup& group : groups) {
        for (const StaticIrradiance& probe : group.irradiance)
            append_codes(bytes, probe.codes);
    }
    for (const LightGroup& group : groups) {
        for (const StaticIrradiance& probe : group.irradiance)
            append_le(bytes, probe.exponent);
    }
    return bytes;
}

std::uint8_t flags_of(const ProbeQuality& probe) {
    using Layout = layout::QualityLayout;
    unsigned flags = 0;
    if (probe.budget_ended)
        flags |= Layout::budget_ended_bit;
    if (probe.dark)
        flags |= Layout::dark_bit;
    if (probe.moved)
        flags |= Layout::moved_bit;
    return static_cast<std::uint8_t>(flags);
}

ByteVector quality_section(const Quality& quality) {
    using Layout = layout::QualityLayout;
    ByteVector bytes;
    append_le(bytes, quality.buried_cells);
    append_le(bytes, quality.blind_cells);
    append_u16(bytes, quality.group_errors.size());
    append_zeros(bytes, Layout::header_bytes - Layout::reserved);
    for (const ProbeQuality& probe : quality.probes) {
        append_f32(bytes, probe.transfer_error);
        append_f32(bytes, probe.visibility_error);
        append_f32(bytes, probe.static_error);
        append_le(bytes, probe.paths);
        append_le(bytes, probe.back_hits);
        bytes.push_back(flags_of(probe));
        append_zeros(bytes, Layout::probe_bytes - Layout::probe_reserved);
    }
    for (const std::vector<float>& errors : quality.group_errors) {
        for (const float error : errors)
            append_f32(bytes, error);
    }
    return bytes;
}

}  // namespace

std::vector<RawSection> raw_sections(const Sector& sector) {
    std::vector<RawSection> sections;
    const auto add = [&](SectionKind kind, ByteVector bytes) {
        sections.push_back({kind, std::move(bytes)});
    };
    add(SectionKind::bake, bake_section(sector.bake));
    add(SectionKind::positions, positions_section(sector.probes));
    add(SectionKind::sky_visibility, sky_visibility_section(sector.probes));
    add(SectionKind::transfer, transfer_section(sector.probes));
    add(SectionKind::grid, grid_section(sector.grid));
    add(SectionKind::statistics, statistics_section(sector.statistics));
    if (!sector.static_irradiance.empty())
        add(SectionKind::static_irradiance, static_irradiance_section(sector.static_irradiance));
    if (sector.local_transfer) {
        add(SectionKind::local_transfer, local_transfer_section(*sector.local_transfer));
        if (sector.local_transfer->sources.size() > max_probes)
            sections.back().version = layout::many_sources_local_version;
    }
    if (sector.convergence)
        add(SectionKind::convergence, convergence_section(*sector.convergence));
    if (!sector.interiors.empty())
        add(SectionKind::interiors, interiors_section(sector.interiors));
    if (!sector.light_groups.empty())
        add(SectionKind::light_groups, light_groups_section(sector.light_groups));
    if (sector.quality)
        add(SectionKind::quality, quality_section(*sector.quality));
    return sections;
}

}  // namespace drtv
