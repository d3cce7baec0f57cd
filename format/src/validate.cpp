#include <drtv/validate.h>

#include <drtv/read.h>
#include <drtv/sector.h>

#include "findings.h"
#include "sections.h"
#include "validate_rules.h"

#include <algorithm>
#include <cassert>

namespace drtv {
namespace {

const Issue& issue_of(ReadError error) {
    switch (error) {
        case ReadError::not_a_sector_file:
            return issue::not_a_sector_file;
        case ReadError::unsupported_version:
            return issue::unsupported_version;
        case ReadError::truncated:
            return issue::truncated;
        case ReadError::trailing_bytes:
            return issue::trailing_bytes;
        case ReadError::bad_header:
            return issue::header;
        case ReadError::bad_table:
            return issue::table;
        case ReadError::checksum_mismatch:
            return issue::checksum;
        case ReadError::missing_section:
            return issue::missing_section;
        case ReadError::none:
        case ReadError::compressed:
        case ReadError::misaligned:
        case ReadError::bad_section:
            break;
    }
    return issue::section;
}

void check_unknown_sections(const SectionTable& table, const Sections& sections, Findings& findings) {
    for (std::size_t n = 0; n < table.count; ++n) {
        const SectionEntry& entry = table.entries[n];
        if (entry.kind < known_kinds && sections.of_kind[entry.kind].present)
            continue;
        findings.add(
            issue::unknown_section,
            entry.offset,
            entry.kind,
            [] { return std::string(); },
            [&] {
                return section_name(entry) + " of version " + std::to_string(entry.version) +
                       " is none that a file of this version has, and was skipped";
            });
    }
}

}  // namespace

bool admit(Report& report, const Issue& issue, const ValidateOptions& options) {
    // What cannot be read cannot be valid, whoever wants to ignore it.
    const bool unreadable = issue.group == IssueGroup::structure && issue.severity == Severity::error;
    if (!unreadable && std::ranges::find(options.ignored, &issue) != options.ignored.end())
        return false;
    ++(issue.severity == Severity::error ? report.errors : report.warnings);
    if (report.findings.size() < options.max_findings)
        return true;
    report.truncated = true;
    return false;
}

Report validate_sector(std::span<const std::uint8_t> bytes, const ValidateOptions& options) {
    assert(options.max_findings > 0);
    Findings findings(options);
    SectionTable table;
    Unpacking unpacking{unpack_section};
    Sections sections;
    if (const ReadStatus status = load_sections(bytes, table, &unpacking, sections); !status.ok()) {
        findings.add(
            issue_of(status.error),
            status.offset,
            std::nullopt,
            [] { return std::string(); },
            [&] { return status.message; });
        return findings.take();
    }
    check_unknown_sections(table, sections, findings);
    if (options.quick)
        return findings.take();

    Sector sector;
    copy_sector(bytes, sections, sector);
    const auto check = [&](SectionKind kind) {
        return SectionCheck{sector, sections.of(kind).place, findings};
    };
    check_settings(check(SectionKind::bake));
    check_probe_positions(check(SectionKind::positions));
    check_sky_visibility(check(SectionKind::sky_visibility));
    check_transfer(check(SectionKind::transfer));
    check_grid(check(SectionKind::grid));
    check_static_irradiance(check(SectionKind::static_irradiance));
    check_local_transfer(check(SectionKind::local_transfer));
    check_convergence(check(SectionKind::convergence));
    check_interiors(check(SectionKind::interiors));
    check_light_groups(check(SectionKind::light_groups));
    check_quality(check(SectionKind::quality));
    return findings.take();
}

}  // namespace drtv
