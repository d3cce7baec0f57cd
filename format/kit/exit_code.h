// How the project's programs end, and what they say then.
#pragma once

#include <string>

namespace drtv::kit {

enum ExitCode : int {
    exit_valid = 0,
    exit_usage = 1,
    exit_unreadable = 2,
    exit_invalid = 3,
    exit_different = 4
};

// One sentence to stderr, the program's name before it: "drtv: ...".
void complain(const std::string& sentence);

}  // namespace drtv::kit
