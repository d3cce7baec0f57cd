// Runs a program of the cluster to its end.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::executor {

// What it wrote to standard output. A sentence where it could not be started, ended with another status than
// 0 (with the last line of its standard error), or was not done in time: it is killed then, with all that it
// started. It reads from an empty input.
[[nodiscard]] tl::expected<std::string, std::string> run_command(const std::vector<std::string>& command,
                                                                 std::chrono::milliseconds time_limit);

}  // namespace drtv::executor
