// The table of all issues that a validator can find. Constants, thread-safe.
//
//     const drtv::Issue* issue = drtv::issue_of_code("CHECKSUM");
//     if (issue != nullptr && issue->severity == drtv::Severity::error) puts("a file with it is invalid");
//
// A code never changes its meaning and is never used again for another issue. `STRUCTURE` of drtv 0.1.0 is
// retired: the codes of the group `structure` replace it. `drtv issues` prints format/ISSUES.md from this
// table.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace drtv {

enum class Severity : std::uint8_t { error, warning };

enum class IssueGroup : std::uint8_t {
    structure,     // a reader checks these too, except the warnings
    quantisation,  // codes and exponents
    physics,       // values that no passive scene gives
    index,         // references to probes and sources, and names
    borders,       // two sectors side by side, --neighbours only
    set,           // all sectors of a folder, --neighbours only
};

// "structure", ...
[[nodiscard]] std::string_view name_of(IssueGroup group);

// One kind of finding.
struct Issue {
    std::string_view code;
    Severity severity;
    IssueGroup group;
    std::string_view meaning;
};

struct ErrorIssue : Issue {
    constexpr ErrorIssue(std::string_view code_, IssueGroup group_, std::string_view meaning_)
        : Issue{code_, Severity::error, group_, meaning_} {}
};
struct WarningIssue : Issue {
    constexpr WarningIssue(std::string_view code_, IssueGroup group_, std::string_view meaning_)
        : Issue{code_, Severity::warning, group_, meaning_} {}
};

namespace issue {

using enum IssueGroup;

inline constexpr ErrorIssue not_a_sector_file("NOT_A_SECTOR_FILE",
                                              structure,
                                              "the file is too short, or does not start with DRTV");
inline constexpr ErrorIssue unsupported_version(
    "UNSUPPORTED_VERSION", structure, "the file, or a section that it must have, is of another version");
inline constexpr ErrorIssue truncated("TRUNCATED", structure, "the file is shorter than its header says");
inline constexpr ErrorIssue trailing_bytes("TRAILING_BYTES",
                                           structure,
                                           "the file is longer than its header says");
inline constexpr ErrorIssue header("HEADER", structure, "a field of the header breaks its rule");
inline constexpr ErrorIssue table("TABLE", structure, "an entry of the table of sections breaks its rule");
inline constexpr ErrorIssue checksum("CHECKSUM",
                                     structure,
                                     "a stored checksum does not match the bytes it covers");
inline constexpr ErrorIssue missing_section("MISSING_SECTION",
                                            structure,
                                            "a section that every file must have is missing");
inline constexpr ErrorIssue section("SECTION",
                                    structure,
                                    "the content of a section breaks a rule of its structure");
inline constexpr WarningIssue unknown_section(
    "UNKNOWN_SECTION",
    structure,
    "a section is of a kind or version that this validator does not know; it was not looked into");

inline constexpr ErrorIssue fixed_point_reserved("FIXED_POINT_RESERVED",
                                                 quantisation,
                                                 "a coefficient has the reserved code -32768");
inline constexpr WarningIssue fixed_point_saturated(
    "FIXED_POINT_SATURATED",
    quantisation,
    "a coefficient has the largest code under the largest exponent: its value may have been larger");
inline constexpr ErrorIssue static_exponent("STATIC_EXPONENT",
                                            quantisation,
                                            "the exponent of a static irradiance lies outside -64 to 64");
inline constexpr ErrorIssue local_exponent(
    "LOCAL_EXPONENT",
    quantisation,
    "the exponents of a pair's receiver and source add up to less than -126 or more than 63");

inline constexpr ErrorIssue sky_visibility_range("SKY_VISIBILITY_RANGE",
                                                 physics,
                                                 "a sky visibility lies outside [0, 1]");
inline constexpr ErrorIssue sky_visibility_down("SKY_VISIBILITY_DOWN",
                                                physics,
                                                "the sky visibility of the downward direction is not 0");
inline constexpr ErrorIssue transfer_range("TRANSFER_RANGE",
                                           physics,
                                           "a transfer coefficient is larger than a passive scene allows");
inline constexpr ErrorIssue transfer_sign(
    "TRANSFER_SIGN",
    physics,
    "a transfer coefficient of Y0 or Y2 is negative: more light from above would give less");
inline constexpr ErrorIssue transfer_band(
    "TRANSFER_BAND",
    physics,
    "a transfer coefficient is more than sqrt(3) times that of Y0: light would be negative");
inline constexpr ErrorIssue energy("ENERGY", physics, "under a sky of radiance 1 a probe sees more than 1");
inline constexpr ErrorIssue static_irradiance_range("STATIC_IRRADIANCE_RANGE",
                                                    physics,
                                                    "a static irradiance is negative");
inline constexpr ErrorIssue local_transfer_range(
    "LOCAL_TRANSFER_RANGE",
    physics,
    "a local transfer coefficient is larger than light that is nowhere negative allows");
inline constexpr WarningIssue local_reciprocity(
    "LOCAL_RECIPROCITY",
    physics,
    "local transfer there and back has little in common: rows may "
    "belong to other probes, or most probes touch a wall");
inline constexpr ErrorIssue interior_open("INTERIOR_OPEN", physics, "the mesh of an interior is not closed");
inline constexpr WarningIssue interior_inside_out(
    "INTERIOR_INSIDE_OUT",
    physics,
    "the mesh of an interior encloses no volume, or its triangles face inwards");
inline constexpr WarningIssue interior_probe("INTERIOR_PROBE",
                                             physics,
                                             "the probe of an interior stands outside of its bounds");
inline constexpr ErrorIssue settings_range("SETTINGS_RANGE",
                                           physics,
                                           "a recorded setting lies outside its range");
inline constexpr ErrorIssue convergence_range(
    "CONVERGENCE_RANGE", physics, "a recorded error or number of paths is negative or out of order");

inline constexpr ErrorIssue grid_reference("GRID_REFERENCE",
                                           index,
                                           "a grid cell names a probe that is not there");
inline constexpr ErrorIssue grid_no_probe("GRID_NO_PROBE",
                                          index,
                                          "a grid cell is empty although the sector has probes for it");
inline constexpr ErrorIssue duplicate_position("DUPLICATE_POSITION",
                                               index,
                                               "two probes stand at the same position");
inline constexpr ErrorIssue local_source_count("LOCAL_SOURCE_COUNT",
                                               index,
                                               "a probe takes light from more than 128 local sources");
inline constexpr ErrorIssue local_source_duplicate("LOCAL_SOURCE_DUPLICATE",
                                                   index,
                                                   "two local sources are the same probe");

inline constexpr ErrorIssue light_group_name(
    "LIGHT_GROUP_NAME",
    index,
    "the name of a light group is not UTF-8, or does not sort after the name before it");

inline constexpr ErrorIssue neighbour_source(
    "NEIGHBOUR_SOURCE", borders, "a local source is a probe that the neighbouring sector does not have");
inline constexpr WarningIssue neighbour_sections(
    "NEIGHBOUR_SECTIONS",
    borders,
    "one of two neighbouring sectors has a section of light that the other lacks");
inline constexpr WarningIssue neighbour_step("NEIGHBOUR_STEP",
                                             borders,
                                             "light changes across a border much more than inside the two "
                                             "sectors, and than heights and sky visibility "
                                             "on both sides explain: they were baked from different maps");

inline constexpr ErrorIssue set_duplicate("SET_DUPLICATE", set, "two files hold the same sector");
inline constexpr ErrorIssue set_settings(
    "SET_SETTINGS", set, "the sector was baked with another settings key than most of the folder");
inline constexpr WarningIssue set_hole("SET_HOLE",
                                       set,
                                       "a sector is missing although sectors are all around it");
inline constexpr WarningIssue set_file_name("SET_FILE_NAME",
                                            set,
                                            "the file name says another sector than the file holds");

}  // namespace issue

// All issues, in the order of this header.
[[nodiscard]] std::span<const Issue* const> all_issues();

// Null where no issue has this code.
[[nodiscard]] const Issue* issue_of_code(std::string_view code);

}  // namespace drtv
