#include "bakerd/map/json_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace drtv::map {

std::string broken_at(std::string_view json, std::size_t at) {
    const std::string_view before = json.substr(0, at);
    const auto line = 1 + std::ranges::count(before, '\n');
    const std::size_t column = at - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
    const std::string_view how = at >= json.size() ? "ends too early" : "is broken";
    return fmt::format("{} at line {}, column {}", how, line, column);
}

}  // namespace drtv::map
