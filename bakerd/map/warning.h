// Sentences for people: warnings of the import, and text that a file gave.
#pragma once

#include "bakerd/map/map.h"

#include <string>

namespace drtv::map {

[[nodiscard]] constexpr bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

// One line of sensible length, whatever stands in the names that the file gave.
[[nodiscard]] std::string as_sentence(std::string text);

// Adds a warning to the map, once. After the first hundred none is added.
void warn(Map& map, const std::string& text);

}  // namespace drtv::map
