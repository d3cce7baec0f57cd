// Whether bytes are UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace drtv {

// As table 3-7 of the Unicode Standard 15 has it: no overlong forms, no surrogates, nothing above U+10FFFF.
[[nodiscard]] inline bool is_utf8(std::string_view text) {
    std::size_t at = 0;
    const auto byte = [&](std::size_t n) -> std::uint8_t {
        return at + n < text.size() ? static_cast<std::uint8_t>(text[at + n]) : 0;
    };
    while (at < text.size()) {
        const std::uint8_t first = byte(0);
        const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
        const bool is_first = first < 0x80 || (first >= 0xC2 && first <= 0xF4);
        const std::uint8_t low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
        const std::uint8_t high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
        if (!is_first || (length > 1 && (byte(1) < low || byte(1) > high)))
            return false;
        for (std::size_t n = 2; n < length; ++n) {
            if ((byte(n) & 0xC0) != 0x80)
                return false;
        }
        at += length;
    }
    return true;
}

}  // namespace drtv
