// Checks of what options take; each complains with a sentence that names the value.
#pragma once

#include <CLI/CLI.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace drtv::cli {

// "a, b, c"
[[nodiscard]] std::string joined(const std::vector<std::string>& words);

[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);
[[nodiscard]] CLI::Validator whole_number(std::size_t min, std::size_t max);
[[nodiscard]] CLI::Validator number_between(double min, double max);
// Above 0 and below `max`.
[[nodiscard]] CLI::Validator number_below(double max);
[[nodiscard]] CLI::Validator finite_number();

}  // namespace drtv::cli
