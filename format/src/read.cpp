// From checked sections to a sector in memory.
#include <drtv/read.h>

#include "bytes.h"
#include "sections.h"

#include <cstring>

namespace drtv {
namespace {

using Bytes = std::span<const std::uint8_t>;

BakeRecord read_bake(Bytes raw) {
    BakeRecord bake;
    bake.rays = load_le<std::uint32_t>(raw, 0);
    bake.bounces = load_le<std::uint32_t>(raw, 4);
    bake.reach_m = load_f32(raw, 8);
    bake.min_distance_m = load_f32(raw, 12);
    std::memcpy(bake.settings_key.data(), raw.data() + 16, bake.settings_key.size());
    return bake;
}

void read_probes(const Sections& sections, std::vector<Probe>& probes) {
    const Bytes positions = sections.of(SectionKind::positions).raw;
    std::size_t position_at = 0, visibility_at = 0, transfer_at = 0;
    for (Probe& probe : probes) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            probe.position[axis] = load_le<std::uint16_t>(positions, position_at + 2 * axis);
        probe.kind = static_cast<ProbeKind>(positions[position_at + 6]);
        position_at += layout::position_bytes;
        visibility_at =
            load_codes(sections.of(SectionKind::sky_visibility).raw, visibility_at, probe.sky_visibility);
        transfer_at = load_codes(sections.of(SectionKind::transfer).raw, transfer_at, probe.transfer);
    }
}

void read_grid(Bytes raw, Grid& grid) {
    grid.z_origin_units = load_i32(raw, 0);
    grid.cell_height_units = load_le<std::uint32_t>(raw, 4);
    std::memcpy(grid.cells.data(), raw.data() + layout::grid_header_bytes, grid.cells.size());
}

Statistics read_statistics(Bytes raw) {
    Statistics s;
    s.candidates = load_le<std::uint32_t>(raw, 0);
    s.moved_out = load_le<std::uint32_t>(raw, 4);
    s.dropped_in_solid = load_le<std::uint32_t>(raw, 8);
    s.removed_by_volume = load_le<std::uint32_t>(raw, 12);
    s.thinned = load_le<std::uint32_t>(raw, 16);
    s.used_distance_m = load_f32(raw, 20);
    s.rays = load_le<std::uint64_t>(raw, 24);
    s.back_hits = load_le<std::uint64_t>(raw, 32);
    return s;
}

void read_static_irradiance(Bytes raw, std::vector<StaticIrradiance>& probes) {
    std::size_t at = 0;
    for (StaticIrradiance& probe : probes)
        at = load_codes(raw, at, probe.codes);
    for (StaticIrradiance& probe : probes)
        probe.exponent = static_cast<std::int8_t>(raw[at++]);
}

void read_local_transfer(Bytes raw, std::size_t probe_count, LocalTransfer& local) {
    using Local = layout::LocalTransferLayout;
    local.sources.resize(load_le<std::uint16_t>(raw, Local::source_count));
    local.receivers.resize(probe_count);
    local.pairs.resize(load_le<std::uint32_t>(raw, Local::pair_count));
    const Local parts(probe_count, local.sources.size(), local.pairs.size());
    const std::size_t mask_bytes = Local::mask_bytes(local.sources.size());
    for (std::size_t s = 0; s < local.sources.size(); ++s) {
        const std::size_t at = Local::source_at(s);
        local.sources[s] = {static_cast<std::int8_t>(raw[at]),
                            static_cast<std::int8_t>(raw[at + 1]),
                            raw[at + 2],
                            static_cast<std::int8_t>(raw[at + 3])};
    }
    for (std::size_t p = 0; p < probe_count; ++p) {
        local.receivers[p].first_pair = load_le<std::uint32_t>(raw, parts.receiver_at(p));
        local.receivers[p].exponent = static_cast<std::int8_t>(raw[parts.receiver_at(p) + 4]);
        std::memcpy(local.receivers[p].sources.data(), raw.data() + parts.masks + p * mask_bytes, mask_bytes);
    }
    std::size_t at = parts.codes;
    for (LightCodes& pair : local.pairs)
        at = load_codes(raw, at, pair);
}

Convergence read_convergence(Bytes raw) {
    Convergence c;
    std::size_t at = 0;
    for (float* error : {&c.error_asked, &c.error_median, &c.error_p95, &c.error_max}) {
        *error = load_f32(raw, at);
        at += 4;
    }
    for (std::uint32_t* count : {&c.paths_least, &c.paths_most, &c.local_bounces, &c.local_rays}) {
        *count = load_le<std::uint32_t>(raw, at);
        at += 4;
    }
    c.static_rays = load_le<std::uint64_t>(raw, at);
    c.local_transfer_rays = load_le<std::uint64_t>(raw, at + 8);
    return c;
}

void read_interiors(Bytes raw, std::vector<Interior>& interiors) {
    using Rooms = layout::InteriorsLayout;
    interiors.resize(load_le<std::uint16_t>(raw, Rooms::interior_count));
    const Rooms parts(interiors.size(),
                      load_le<std::uint32_t>(raw, Rooms::vertex_count),
                      load_le<std::uint32_t>(raw, Rooms::triangle_count));
    std::size_t vertex_at = parts.vertices, triangle_at = parts.triangles;
    const auto read_triples =
        [&](std::size_t& at, std::size_t count, std::vector<std::array<std::uint16_t, 3>>& triples) {
            triples.resize(count);
            for (auto& triple : triples) {
                for (std::uint16_t& value : triple) {
                    value = load_le<std::uint16_t>(raw, at);
                    at += sizeof value;
                }
            }
        };
    for (std::size_t n = 0; n < interiors.size(); ++n) {
        const std::size_t at = Rooms::entry_at(n);
        Interior& interior = interiors[n];
        for (std::size_t axis = 0; axis < 3; ++axis)
            interior.origin_units[axis] = load_i32(raw, at + Rooms::origin + 4 * axis);
        interior.shift = raw[at + Rooms::shift];
        interior.probe = raw[at + Rooms::probe];
        read_triples(vertex_at, load_le<std::uint32_t>(raw, at + Rooms::vertices_of), interior.vertices);
        read_triples(triangle_at, load_le<std::uint32_t>(raw, at + Rooms::triangles_of), interior.triangles);
    }
}

}  // namespace

void copy_sector(Bytes file, const Sections& sections, Sector& sector) {
    namespace h = layout::header;
    sector.i = load_i32(file, h::sector_i);
    sector.j = load_i32(file, h::sector_j);
    sector.z_origin_units = load_i32(file, h::z_origin);
    sector.z_shift = file[h::z_shift];
    sector.probes.resize(sections.probe_count);
    sector.bake = read_bake(sections.of(SectionKind::bake).raw);
    read_probes(sections, sector.probes);
    read_grid(sections.of(SectionKind::grid).raw, sector.grid);
    sector.statistics = read_statistics(sections.of(SectionKind::statistics).raw);
    if (const Section& section = sections.of(SectionKind::static_irradiance); section.present) {
        sector.static_irradiance.resize(sections.probe_count);
        read_static_irradiance(section.raw, sector.static_irradiance);
    }
    if (const Section& section = sections.of(SectionKind::local_transfer); section.present)
        read_local_transfer(section.raw, sections.probe_count, sector.local_transfer.emplace());
    if (const Section& section = sections.of(SectionKind::convergence); section.present)
        sector.convergence = read_convergence(section.raw);
    if (const Section& section = sections.of(SectionKind::interiors); section.present)
        read_interiors(section.raw, sector.interiors);
}

ReadStatus read_sector(Bytes bytes, Sector& sector) {
    SectionTable table;
    Unpacked unpacked;
    Sections sections;
    if (ReadStatus status = load_sections(bytes, table, &unpacked, sections); !status.ok())
        return status;
    Sector read;
    copy_sector(bytes, sections, read);
    sector = std::move(read);
    return {};
}

}  // namespace drtv
