#include <drtv/validate.h>

#include <drtv/read.h>
#include <drtv/sector.h>

#include "decode_section.h"
#include "findings.h"
#include "layout.h"
#include "validate_light.h"

#include <array>
#include <cassert>
#include <cmath>

namespace drtv {
namespace {

constexpr std::array<Issue, issue_count> issues = {{
    {"STRUCTURE", Severity::error, "header, table or a section breaks a structural rule"},
    {"CHECKSUM", Severity::error, "a stored checksum does not match the bytes it covers"},
    {"UNSUPPORTED_VERSION", Severity::error, "the file, or a section that it must have, is of another version"},
    {"FIXED_POINT_RESERVED", Severity::error, "a coefficient has the reserved code -32768"},
    {"SKY_VISIBILITY_RANGE", Severity::error, "a sky visibility lies outside [0, 1]"},
    {"SKY_VISIBILITY_DOWN", Severity::error, "the sky visibility of the downward direction is not 0"},
    {"TRANSFER_RANGE", Severity::error, "a transfer coefficient is larger than a passive scene allows"},
    {"GRID_REFERENCE", Severity::error, "a grid cell names a probe that is not there"},
    {"GRID_NO_PROBE", Severity::error, "a grid cell is empty although the sector has probes"},
    {"SETTINGS_RANGE", Severity::error, "a recorded setting lies outside its range"},
    {"DUPLICATE_POSITION", Severity::error, "two probes stand at the same position"},
    {"STATIC_IRRADIANCE_RANGE", Severity::error, "a static irradiance is negative"},
    {"STATIC_EXPONENT", Severity::error, "the exponent of a static irradiance lies outside -64 to 64"},
    {"LOCAL_SOURCE_COUNT", Severity::error, "a probe takes light from more than 128 local sources"},
    {"LOCAL_SOURCE_DUPLICATE", Severity::error, "two local sources are the same probe"},
    {"LOCAL_EXPONENT", Severity::error, "the exponents of a pair's receiver and source add up to less than -126 or more than 63"},
    {"LOCAL_TRANSFER_RANGE", Severity::error, "a local transfer coefficient is larger than light that is nowhere negative allows"},
    {"CONVERGENCE_RANGE", Severity::error, "a recorded error or number of paths is negative or out of order"},
}};

layout::Place place_of(std::span<const SectionEntry> entries, SectionKind kind) {
    const SectionEntry* entry = find_section(entries, kind);
    return entry == nullptr ? layout::Place{} : layout::Place{entry->offset, entry->codec == static_cast<std::uint8_t>(Codec::raw)};
}

IssueIndex issue_of(ReadError error) {
    if (error == ReadError::checksum_mismatch) return checksum;
    return error == ReadError::unsupported_version ? unsupported_version : unreadable;
}

void check_sky_visibility(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            const std::int16_t q = sector.probes[p].sky_visibility[b];
            const std::uint64_t offset = place.at(p * layout::sky_visibility_bytes + 2 * b);
            const std::string path = probe_path(p) + ".sky_visibility" + index(b);
            const std::string value = "code " + std::to_string(q);
            if (q == INT16_MIN) findings.add(reserved_code, offset, path, value + " is reserved");
            else if (b == basis_count - 1 && q != 0) findings.add(sky_visibility_down, offset, path, value + ", must be 0");
            else if (q < 0) findings.add(sky_visibility_range, offset, path, value + " is negative");
        }
    }
}

void check_transfer(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        std::uint64_t at = p * layout::transfer_bytes;
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                for (std::size_t i = 0; i < sh_count; ++i, at += 2) {
                    const std::uint64_t offset = place.at(at);
                    const std::int16_t q = sector.probes[p].transfer[c][b][i];
                    const float value = decode_fixed(q, transfer_scale);
                    const float bound = i == 0 ? transfer_bound_y0 : transfer_bound_y1;
                    if (q != INT16_MIN && std::abs(value) <= bound) continue;
                    const std::string path = probe_path(p) + ".transfer." + channel_name[c] + index(b) + index(i);
                    if (q == INT16_MIN) findings.add(reserved_code, offset, path, "code -32768 is reserved");
                    else findings.add(transfer_range, offset, path, std::to_string(value) + " is beyond " + std::to_string(bound));
                }
            }
        }
    }
}

void check_grid(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
        const std::uint8_t probe = sector.grid.cells[cell];
        const std::uint64_t offset = place.at(layout::grid_header_bytes + cell);
        const std::string path = "grid.cells" + index(cell);
        if (probe == no_probe && !sector.probes.empty()) {
            findings.add(grid_no_probe, offset, path, "names no probe, the sector has " + std::to_string(sector.probes.size()));
        } else if (probe != no_probe && probe >= sector.probes.size()) {
            findings.add(grid_reference, offset, path,
                         "names probe " + std::to_string(probe) + ", the sector has " + std::to_string(sector.probes.size()));
        }
    }
}

void check_positions(const Sector& sector, const layout::Place& place, Findings& findings) {
    for (std::size_t p = 1; p < sector.probes.size(); ++p) {
        for (std::size_t q = 0; q < p; ++q) {
            if (sector.probes[p].position != sector.probes[q].position) continue;
            findings.add(duplicate_position, place.at(p * layout::position_bytes), probe_path(p) + ".position",
                         "is that of probe " + std::to_string(q));
            break;
        }
    }
}

void check_bake(const BakeRecord& bake, const layout::Place& place, Findings& findings) {
    if (bake.rays == 0) findings.add(settings_range, place.at(0), "settings.rays", "is 0");
    if (!(bake.reach_m > 0)) findings.add(settings_range, place.at(8), "settings.reach", std::to_string(bake.reach_m) + " m is not positive");
    if (!(bake.min_distance_m > 0)) {
        findings.add(settings_range, place.at(12), "settings.min_distance", std::to_string(bake.min_distance_m) + " m is not positive");
    }
}

}  // namespace

std::span<const Issue> all_issues() { return issues; }

std::vector<Finding> validate_sector(std::span<const std::uint8_t> bytes, std::size_t max_findings) {
    assert(max_findings > 0);
    Findings findings(max_findings);
    Sector sector;
    if (const ReadStatus status = read_sector(bytes, sector); !status.ok()) {
        findings.add(issue_of(status.error), status.offset, "", status.message);
        return findings.take();
    }
    std::vector<SectionEntry> entries;
    if (!read_section_table(bytes, entries).ok()) return findings.take();
    check_bake(sector.bake, place_of(entries, SectionKind::bake), findings);
    check_positions(sector, place_of(entries, SectionKind::positions), findings);
    check_sky_visibility(sector, place_of(entries, SectionKind::sky_visibility), findings);
    check_transfer(sector, place_of(entries, SectionKind::transfer), findings);
    check_grid(sector, place_of(entries, SectionKind::grid), findings);
    check_static_irradiance(sector, place_of(entries, SectionKind::static_irradiance), findings);
    check_local_transfer(sector, place_of(entries, SectionKind::local_transfer), findings);
    check_convergence(sector, place_of(entries, SectionKind::convergence), findings);
    return findings.take();
}

}  // namespace drtv
