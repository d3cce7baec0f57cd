// The tool's commands. Each takes the arguments after its name and gives the exit code of DESIGN section 6.
#pragma once

#include <span>
#include <string>

namespace drtv::tool {

enum ExitCode : int {
    exit_valid = 0,
    exit_usage = 1,
    exit_unreadable = 2,
    exit_invalid = 3,
    exit_different = 4
};

using Arguments = std::span<const std::string>;

int run_validate(Arguments arguments);
int run_info(Arguments arguments);
int run_dump(Arguments arguments);
int run_preview(Arguments arguments);
int run_strip(Arguments arguments);
int run_diff(Arguments arguments);
int run_issues(Arguments arguments);

// One sentence to stderr, "drtv: " before it.
void complain(const std::string& sentence);

}  // namespace drtv::tool
