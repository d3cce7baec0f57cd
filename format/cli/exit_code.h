// How the project's programs end: one table for all of them (docs/exit-codes.md).
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace drtv::cli {

// Scripts rely on them: a number never changes its meaning.
enum ExitCode : int {
    exit_done = 0,
    exit_usage = 1,
    exit_unreadable = 2,
    exit_invalid = 3,
    exit_different = 4,
    exit_job_failed = 5,
    exit_unfinished = 6,
    exit_server = 7,
    exit_timeout = 8,
    exit_differs = 9,
    exit_interrupted = 130,  // as shells count SIGINT
};

struct ExitMeaning {
    ExitCode code;
    std::string_view meaning;
    // Which program ends so.
    bool drtv;
    bool bake;
    bool bakerd;
};

[[nodiscard]] std::span<const ExitMeaning> exit_meanings();

// What `program` ("drtv", "bake" or "bakerd") may end with, a line each. For its help.
[[nodiscard]] std::string exit_code_help(std::string_view program);

}  // namespace drtv::cli
