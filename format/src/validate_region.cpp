#include <drtv/validate_region.h>

#include "border_step.h"
#include "layout.h"
#include "region_borders.h"
#include "region_findings.h"
#include "region_holes.h"
#include "region_map.h"
#include "section_table.h"
#include "sentence.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace drtv {
namespace {

using SettingsKey = std::array<std::uint8_t, 32>;

RegionMap map_of(std::span<const RegionSector> sectors,
                 std::span<const std::array<std::int32_t, 2>> also_there,
                 RegionFindings& findings) {
    RegionMap map{sectors, {}, {}};
    for (const auto& [i, j] : also_there)
        map.unreadable.insert({i, j});
    for (std::size_t n = 0; n < sectors.size(); ++n) {
        const auto [entry, added] = map.by_place.try_emplace(coordinate_of(sectors[n]), n);
        if (added)
            continue;
        findings.add(n,
                     {&issue::set_duplicate,
                      layout::header::sector_i,
                      "",
                      std::nullopt,
                      sentence("sector ", text(entry->first), " is in another file of the set too")});
    }
    return map;
}

// Most sectors have been baked with one key: the others are told.
void check_settings_keys(std::span<const RegionSector> sectors, RegionFindings& findings) {
    std::map<SettingsKey, std::size_t> keys;
    for (const RegionSector& sector : sectors)
        ++keys[sector.bake.settings_key];
    const auto by_count = [](const auto& key) { return key.second; };
    const auto [common, count] = *std::ranges::max_element(keys, {}, by_count);
    for (std::size_t n = 0; n < sectors.size(); ++n) {
        if (sectors[n].bake.settings_key == common)
            continue;
        findings.add(
            n,
            {&issue::set_settings,
             0,
             "settings.key",
             std::nullopt,
             sentence("was baked with other settings than ", count, " of the ", sectors.size(), " sectors")});
    }
}

void check_file_names(std::span<const RegionSector> sectors, RegionFindings& findings) {
    for (std::size_t n = 0; n < sectors.size(); ++n) {
        const RegionSector& sector = sectors[n];
        if (!sector.named)
            continue;
        const auto [i, j] = *sector.named;
        const Coordinate named{i, j};
        const Coordinate held = coordinate_of(sector);
        if (named == held)
            continue;
        findings.add(
            n,
            {&issue::set_file_name,
             layout::header::sector_i,
             "",
             std::nullopt,
             sentence("the file is named for sector ", text(named), " and holds sector ", text(held))});
    }
}

// Told at the sector to the west of the hole's first place, or to the south where that one cannot be read.
void report_hole(const Hole& hole, const RegionMap& map, RegionFindings& findings) {
    const auto [i, j] = hole.first;
    auto beside = map.by_place.find({i - 1, j});
    const bool at_west = beside != map.by_place.end();
    if (!at_west)
        beside = map.by_place.find({i, j - 1});
    if (beside == map.by_place.end())
        return;
    const std::string more =
        hole.size_sectors == 1 ? "" : sentence(" with ", hole.size_sectors - 1, " more beside it");
    findings.add(beside->second,
                 {&issue::set_hole,
                  layout::header::sector_i,
                  "",
                  static_cast<double>(hole.size_sectors),
                  sentence("sector ",
                           text(hole.first),
                           " to its ",
                           at_west ? "east" : "north",
                           " is missing",
                           more,
                           ", and sectors are all around")});
}

void check_holes(const RegionMap& map, RegionFindings& findings) {
    std::set<Coordinate> there = map.unreadable;
    for (const auto& [place, n] : map.by_place)
        there.insert(place);
    for (const Hole& hole : find_holes(there))
        report_hole(hole, map, findings);
}

}  // namespace

ReadStatus read_region_sector(std::span<const std::uint8_t> bytes, RegionSector& sector) {
    Sector read;
    SectionTable table;
    if (ReadStatus status = read_sector(bytes, read); !status.ok())
        return status;
    if (ReadStatus status = load_section_table(bytes, table); !status.ok())
        return status;
    RegionSector region;
    region.i = read.i;
    region.j = read.j;
    region.named = sector.named;
    region.bake = read.bake;
    region.position_step_units = 1 << read.z_shift;
    for (const Probe& probe : read.probes) {
        region.positions.push_back(position_units(read, probe));
        region.kinds.push_back(probe.kind);
        region.light.push_back(light_under_white_sky(probe));
        std::array<float, basis_count>& sky = region.sky_visibility.emplace_back();
        for (std::size_t b = 0; b < basis_count; ++b)
            sky[b] = decode_fixed(probe.sky_visibility[b], sky_visibility_scale);
    }
    region.grid = read.grid;
    region.has_local_transfer = read.local_transfer.has_value();
    if (read.local_transfer)
        region.local_sources = std::move(read.local_transfer->sources);
    if (const SectionEntry* entry = table.find(SectionKind::local_transfer)) {
        region.local_offset = entry->offset;
        region.local_raw = entry->codec == static_cast<std::uint8_t>(Codec::raw);
    }
    sector = std::move(region);
    return {};
}

std::vector<RegionFinding> validate_region(std::span<const RegionSector> sectors,
                                           std::span<const std::array<std::int32_t, 2>> also_there) {
    if (sectors.empty())
        return {};
    RegionFindings findings;
    const RegionMap map = map_of(sectors, also_there, findings);
    check_settings_keys(sectors, findings);
    check_file_names(sectors, findings);
    check_holes(map, findings);
    check_borders(map, findings);
    return findings.take();
}

}  // namespace drtv
