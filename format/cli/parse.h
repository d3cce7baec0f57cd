// Taking a command line apart, and saying what is wrong with it.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>

namespace drtv::cli {

// Parses. Gives an exit code where the program ends with that: after --help and --version, and after a
// complaint, which names the command and what was likely meant.
[[nodiscard]] std::optional<int> parse(CLI::App& app, int argc, const char* const* argv);

}  // namespace drtv::cli
