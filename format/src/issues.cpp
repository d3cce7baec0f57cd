#include <drtv/issues.h>

#include <array>

namespace drtv {
namespace {

constexpr std::array<const Issue*, 41> issues = {
    &issue::not_a_sector_file,
    &issue::unsupported_version,
    &issue::truncated,
    &issue::trailing_bytes,
    &issue::header,
    &issue::table,
    &issue::checksum,
    &issue::missing_section,
    &issue::section,
    &issue::unknown_section,
    &issue::fixed_point_reserved,
    &issue::fixed_point_saturated,
    &issue::static_exponent,
    &issue::local_exponent,
    &issue::sky_visibility_range,
    &issue::sky_visibility_down,
    &issue::transfer_range,
    &issue::transfer_sign,
    &issue::transfer_band,
    &issue::energy,
    &issue::static_irradiance_range,
    &issue::local_transfer_range,
    &issue::local_reciprocity,
    &issue::interior_open,
    &issue::interior_inside_out,
    &issue::interior_probe,
    &issue::settings_range,
    &issue::convergence_range,
    &issue::grid_reference,
    &issue::grid_no_probe,
    &issue::duplicate_position,
    &issue::local_source_count,
    &issue::local_source_duplicate,
    &issue::light_group_name,
    &issue::neighbour_source,
    &issue::neighbour_sections,
    &issue::neighbour_step,
    &issue::set_duplicate,
    &issue::set_settings,
    &issue::set_hole,
    &issue::set_file_name,
};

}  // namespace

std::string_view name_of(IssueGroup group) {
    switch (group) {
        case IssueGroup::structure:
            return "structure";
        case IssueGroup::quantisation:
            return "quantisation";
        case IssueGroup::physics:
            return "physics";
        case IssueGroup::index:
            return "index";
        case IssueGroup::borders:
            return "borders";
        case IssueGroup::set:
            return "set";
    }
    return "unknown";
}

std::span<const Issue* const> all_issues() {
    return issues;
}

const Issue* issue_of_code(std::string_view code) {
    for (const Issue* issue : issues) {
        if (issue->code == code)
            return issue;
    }
    return nullptr;
}

}  // namespace drtv
