#include "commands.h"

#include <drtv/issues.h>

#include <array>
#include <cstdio>
#include <string>

namespace drtv::tool {
namespace {

constexpr const char* head =
    "# Issues\n"
    "\n"
    "All that `drtv validate` can find. This page is made by `drtv issues`; a test fails where it is stale. "
    "A code never changes its\n"
    "meaning and is never used again. Rules stand in `SPEC.md`.\n"
    "\n"
    "A file with an *error* is invalid: a daemon does not publish it, and `drtv validate` exits with 3. A "
    "*warning* is for a person, unless\n"
    "`--warnings-as-errors` says otherwise. `--ignore CODE` leaves a code out. The groups `borders` and "
    "`set` are looked at with\n"
    "`--neighbours` only. Offsets are bytes in the file; inside a compressed section, that section's first "
    "byte.\n";

struct GroupText {
    IssueGroup group;
    const char* title;
};

constexpr std::array<GroupText, 6> groups = {{{IssueGroup::structure, "Structure: can it be read"},
                                              {IssueGroup::quantisation, "Quantisation: codes and exponents"},
                                              {IssueGroup::physics, "Physics: what no passive scene gives"},
                                              {IssueGroup::index, "Index: what names something else"},
                                              {IssueGroup::borders, "Borders: two sectors side by side"},
                                              {IssueGroup::set, "Set: all sectors of a folder"}}};

}  // namespace

constexpr const char* retired = R"(
## Retired

| code | until | now |
|------|-------|-----|
| `STRUCTURE` | 0.1.0 | the codes of the group structure |
| `GRID_NOT_NEAREST` | 0.1.0 | none: a cell names a probe that it sees (SPEC.md, 5.5), which files alone do not tell |
| `NEIGHBOUR_DISTANCE` | 0.1.0 | none: probes that do not see each other may stand near, which files alone do not tell |

A validator of 0.1.0 reports both of bakes whose probes are chosen by sight; `--ignore` leaves them out.
)";

cli::Result<cli::ExitCode> run_issues() {
    std::fputs(head, stdout);
    for (const auto& [group, title] : groups) {
        std::printf("\n## %s\n\n| code | severity | meaning |\n|------|----------|---------|\n", title);
        for (const Issue* issue : all_issues()) {
            if (issue->group != group)
                continue;
            std::printf("| `%s` | %s | %s |\n",
                        std::string(issue->code).c_str(),
                        issue->severity == Severity::error ? "error" : "warning",
                        std::string(issue->meaning).c_str());
        }
    }
    std::fputs(retired, stdout);
    return cli::exit_done;
}

}  // namespace drtv::tool
