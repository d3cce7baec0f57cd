#pragma once

#include <chrono>
#include <cstdint>

namespace drtv::farm {

// Since 1970-01-01 UTC.
[[nodiscard]] inline std::int64_t unix_milliseconds() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

}  // namespace drtv::farm
