// Explicit little-endian loads and stores; sizes are checked by the caller before.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace drtv {

using ByteSpan = std::span<const std::uint8_t>;
using ByteVector = std::vector<std::uint8_t>;

template <std::unsigned_integral Unsigned>
[[nodiscard]] inline Unsigned load_le(ByteSpan bytes, std::size_t offset) {
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

[[nodiscard]] inline std::uint16_t load_u16(ByteSpan bytes, std::size_t offset) {
    return load_le<std::uint16_t>(bytes, offset);
}
[[nodiscard]] inline std::uint32_t load_u32(ByteSpan bytes, std::size_t offset) {
    return load_le<std::uint32_t>(bytes, offset);
}
[[nodiscard]] inline std::uint64_t load_u64(ByteSpan bytes, std::size_t offset) {
    return load_le<std::uint64_t>(bytes, offset);
}
[[nodiscard]] inline std::int8_t load_i8(ByteSpan bytes, std::size_t offset) {
    return static_cast<std::int8_t>(bytes[offset]);
}
[[nodiscard]] inline std::int16_t load_i16(ByteSpan bytes, std::size_t offset) {
    return static_cast<std::int16_t>(load_u16(bytes, offset));
}
[[nodiscard]] inline std::int32_t load_i32(ByteSpan bytes, std::size_t offset) {
    return static_cast<std::int32_t>(load_u32(bytes, offset));
}
[[nodiscard]] inline float load_f32(ByteSpan bytes, std::size_t offset) {
    return __builtin_bit_cast(float, load_u32(bytes, offset));
}

template <std::integral Integer>
inline void append_le(ByteVector& bytes, Integer value) {
    auto rest = static_cast<std::uint64_t>(value);
    for (std::size_t k = 0; k < sizeof(Integer); ++k) {
        bytes.push_back(static_cast<std::uint8_t>(rest));
        rest >>= 8;
    }
}

// REQUIRES: `count` fits.
inline void append_u16(ByteVector& bytes, std::size_t count) {
    append_le(bytes, static_cast<std::uint16_t>(count));
}
inline void append_u32(ByteVector& bytes, std::size_t count) {
    append_le(bytes, static_cast<std::uint32_t>(count));
}
inline void append_f32(ByteVector& bytes, float value) {
    append_le(bytes, __builtin_bit_cast(std::uint32_t, value));
}

inline void append_bytes(ByteVector& bytes, ByteSpan more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}
inline void append_zeros(ByteVector& bytes, std::size_t count) {
    bytes.resize(bytes.size() + count, 0);
}

[[nodiscard]] inline bool all_zero(ByteSpan bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; });
}

// Fixed-point codes of an array of arrays of any depth, the last index fastest. Gives the offset behind them.
inline std::size_t load_codes(ByteSpan bytes, std::size_t offset, std::int16_t& code) {
    code = load_i16(bytes, offset);
    return offset + sizeof code;
}
template <class Element, std::size_t count>
std::size_t load_codes(ByteSpan bytes, std::size_t offset, std::array<Element, count>& codes) {
    for (Element& element : codes)
        offset = load_codes(bytes, offset, element);
    return offset;
}

inline void append_codes(ByteVector& bytes, std::int16_t code) {
    append_le(bytes, code);
}
template <class Element, std::size_t count>
void append_codes(ByteVector& bytes, const std::array<Element, count>& codes) {
    for (const Element& element : codes)
        append_codes(bytes, element);
}

}  // namespace drtv
