// UTF-8 in bytes that may be anything; the validator and the tool ask.
#pragma once

#include <cstddef>
#include <string_view>

namespace drtv {

// Bytes of the UTF-8 sequence at the start of `text`, 0 when there is none (RFC 3629). REQUIRES: not empty.
[[nodiscard]] inline std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t n) {
        return n < text.size() ? unsigned{static_cast<unsigned char>(text[n])} : 0u;
    };
    const unsigned first = byte(0);
    const unsigned second = byte(1);
    if (first < 0x80)
        return 1;
    if (first < 0xC2 || first > 0xF4)
        return 0;
    const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    for (std::size_t n = 1; n < length; ++n) {
        if ((byte(n) & 0xC0u) != 0x80)
            return 0;
    }
    // Longer than need be, a surrogate, or beyond the last code point.
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
        (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F))
        return 0;
    return length;
}

[[nodiscard]] inline bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (length == 0)
            return false;
        text.remove_prefix(length);
    }
    return true;
}

}  // namespace drtv
