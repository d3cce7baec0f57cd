// Runs a program of the cluster to its end.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::executor {

// What it wrote to standard output. A sentence where it could not be started, ended with another status than
// 0 (with the last line of its standard error), or was not done in time: it is killed then, with all that it
// started. It reads from an empty input, and does not see variables of the environment whose names begin with
// what is `hidden`.
[[nodiscard]] tl::expected<std::string, std::string> run_command(const std::vector<std::string>& command,
                                                                 std::chrono::milliseconds time_limit,
                                                                 std::span<const std::string> hidden = {});

}  // namespace drtv::executor
