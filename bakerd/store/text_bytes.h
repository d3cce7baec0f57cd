#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace drtv::store {

// The bytes of a text, as the store takes them. REQUIRES: the text outlives them.
[[nodiscard]] inline std::span<const std::uint8_t> bytes_of_text(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// The text, with U+FFFD for what in it is no UTF-8: what a program printed, to stand in a message.
[[nodiscard]] std::string as_utf8(std::string_view text);

}  // namespace drtv::store
