#include "number_list.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace drtv::cli {

std::optional<std::vector<double>> number_list(std::string_view text, std::size_t count) {
    std::vector<double> numbers;
    for (;;) {
        const std::size_t end = std::min(text.find(','), text.size());
        double number = 0;
        const auto result = std::from_chars(text.data(), text.data() + end, number);
        if (result.ec != std::errc() || result.ptr != text.data() + end || !std::isfinite(number))
            return std::nullopt;
        numbers.push_back(number);
        if (end == text.size())
            break;
        text.remove_prefix(end + 1);
    }
    if (numbers.size() != count)
        return std::nullopt;
    return numbers;
}

std::array<float, 3> float3_of(const double* numbers) {
    return {static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2])};
}

}  // namespace drtv::cli
