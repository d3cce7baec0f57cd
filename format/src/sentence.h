// A message from its parts, so that numbers need no words of their own to stand in it.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

namespace drtv {

inline void append_part(std::string& text, std::string_view part) {
    text += part;
}
inline void append_part(std::string& text, char part) {
    text += part;
}
template <class Number>
requires std::is_arithmetic_v<Number>
void append_part(std::string& text, Number part) {
    text += std::to_string(part);
}

// All parts in their order: text as it is, numbers as std::to_string writes them.
template <class... Parts>
[[nodiscard]] std::string sentence(const Parts&... parts) {
    std::string text;
    (append_part(text, parts), ...);
    return text;
}

}  // namespace drtv
