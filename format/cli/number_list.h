// Numbers in arguments: "1,2.5,-3".
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::cli {

// Nothing unless the text is exactly `count` finite numbers with commas between.
[[nodiscard]] std::optional<std::vector<double>> number_list(std::string_view text, std::size_t count);

[[nodiscard]] std::array<float, 3> float3_of(const double* numbers);

}  // namespace drtv::cli
