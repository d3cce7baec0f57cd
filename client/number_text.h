// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

namespace drtv::client {

// "12,345". REQUIRES: the number is not negative.
[[nodiscard]] std::string with_thousands(std::int64_t number);

// "1 file", "2,000 files".
[[nodiscard]] std::string counted(std::int64_t number, const std::string& one, const std::string& many);

// "46 s", "12 min 46 s", "2 h 5 min". REQUIRES: the duration is not negative.
[[nodiscard]] std::string duration_text(double seconds);

// In millions, as sizes and rates are told.
[[nodiscard]] constexpr double in_millions(double number) {
    return number * 1e-6;
}

[[nodiscard]] constexpr double in_megabytes(std::int64_t size_bytes) {
    return in_millions(static_cast<double>(size_bytes));
}

}  // namespace drtv::client
