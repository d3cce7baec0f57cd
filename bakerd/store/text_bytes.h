#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::store {

// The bytes of a text, as the store takes them. REQUIRES: the text outlives them.
[[nodiscard]] inline std::span<const std::uint8_t> bytes_of_text(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Back, likewise.
[[nodiscard]] inline std::string_view text_of_bytes(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Without their ends; the last one may have none. REQUIRES: the text outlives them.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);

// That is not empty; likewise.
[[nodiscard]] std::string_view last_line(std::string_view text);

// The text, with U+FFFD for what in it is no UTF-8: what a program printed, to stand in a message.
[[nodiscard]] std::string as_utf8(std::string_view text);

}  // namespace drtv::store
