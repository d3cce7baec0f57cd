// Explicit little-endian loads and stores; sizes are checked by the caller before.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace drtv {

template <class Unsigned>
[[nodiscard]] inline Unsigned load_le(std::span<const std::uint8_t> bytes, std::size_t offset) {
    if constexpr (std::endian::native == std::endian::little) {
        Unsigned value;  // the compiler does not see by itself that the loop below is one load
        std::memcpy(&value, bytes.data() + offset, sizeof value);
        return value;
    }
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < sizeof(Unsigned); ++k)
        value |= std::uint64_t{bytes[offset + k]} << (8 * k);
    return static_cast<Unsigned>(value);
}

template <class Unsigned>
inline void append_le(std::vector<std::uint8_t>& bytes, Unsigned value) {
    for (std::size_t k = 0; k < sizeof(Unsigned); ++k) {
        bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * k)));
    }
}

[[nodiscard]] inline std::int8_t load_i8(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return static_cast<std::int8_t>(bytes[offset]);
}
[[nodiscard]] inline std::int16_t load_i16(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return static_cast<std::int16_t>(load_le<std::uint16_t>(bytes, offset));
}
[[nodiscard]] inline std::int32_t load_i32(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return static_cast<std::int32_t>(load_le<std::uint32_t>(bytes, offset));
}
[[nodiscard]] inline float load_f32(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return std::bit_cast<float>(load_le<std::uint32_t>(bytes, offset));
}
inline void append_f32(std::vector<std::uint8_t>& bytes, float value) {
    append_le(bytes, std::bit_cast<std::uint32_t>(value));
}

[[nodiscard]] inline bool all_zero(std::span<const std::uint8_t> bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b == 0; });
}

// Fixed-point codes of an array of arrays of any depth, the last index fastest. Gives the offset behind them.
template <class Element, std::size_t count>
std::size_t load_codes(std::span<const std::uint8_t> bytes,
                       std::size_t offset,
                       std::array<Element, count>& codes) {
    for (Element& element : codes) {
        if constexpr (std::is_same_v<Element, std::int16_t>) {
            element = load_i16(bytes, offset);
            offset += sizeof(std::int16_t);
        } else {
            offset = load_codes(bytes, offset, element);
        }
    }
    return offset;
}

template <class Element, std::size_t count>
void append_codes(std::vector<std::uint8_t>& bytes, const std::array<Element, count>& codes) {
    for (const Element& element : codes) {
        if constexpr (std::is_same_v<Element, std::int16_t>)
            append_le(bytes, static_cast<std::uint16_t>(element));
        else
            append_codes(bytes, element);
    }
}

}  // namespace drtv
