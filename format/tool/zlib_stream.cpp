#include "zlib_stream.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace drtv::tool {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

class BitWriter {
  public:
    explicit BitWriter(Bytes& out) : out_(out) {}

    void put(std::uint32_t bits, unsigned count) {  // least significant bit first
        held_ |= std::uint64_t{bits} << held_count_;
        held_count_ += count;
        while (held_count_ >= 8) {
            out_.push_back(static_cast<std::uint8_t>(held_));
            held_ >>= 8;
            held_count_ -= 8;
        }
    }
    void put_code(std::uint32_t code, unsigned count) {  // Huffman codes go most significant bit first
        std::uint32_t reversed = 0;
        for (unsigned k = 0; k < count; ++k) {
            const std::uint32_t bit = code >> k & 1u;
            reversed = reversed << 1 | bit;
        }
        put(reversed, count);
    }
    void flush() {
        if (held_count_ > 0)
            out_.push_back(static_cast<std::uint8_t>(held_));
        held_count_ = 0;
    }

  private:
    Bytes& out_;
    std::uint64_t held_ = 0;
    unsigned held_count_ = 0;
};

// RFC 1951, 3.2.6.
void put_literal_or_length_code(BitWriter& bits, unsigned symbol) {
    if (symbol < 144)
        bits.put_code(0x30 + symbol, 8);
    else if (symbol < 256)
        bits.put_code(0x190 + symbol - 144, 9);
    else if (symbol < 280)
        bits.put_code(symbol - 256, 7);
    else
        bits.put_code(0xC0 + symbol - 280, 8);
}

constexpr std::size_t min_length = 3;
constexpr std::size_t max_length = 258;
constexpr std::size_t max_distance = 32768;

// A code stands for 2^extra values from its base on; which of them, `extra` bits behind it say.
struct Code {
    std::size_t base;
    unsigned extra;
};

// The tables of RFC 1951, 3.2.5. The last length has a code of its own.
constexpr std::array<Code, 29> length_codes = [] {
    std::array<Code, 29> codes{};
    std::size_t base = min_length;
    for (unsigned n = 0; n < 28; ++n) {
        const unsigned extra = n < 8 ? 0 : n / 4 - 1;
        codes[n] = {base, extra};
        base += std::size_t{1} << extra;
    }
    codes[28] = {max_length, 0};
    return codes;
}();
constexpr std::array<Code, 30> distance_codes = [] {
    std::array<Code, 30> codes{};
    std::size_t base = 1;
    for (unsigned n = 0; n < 30; ++n) {
        const unsigned extra = n < 2 ? 0 : n / 2 - 1;
        codes[n] = {base, extra};
        base += std::size_t{1} << extra;
    }
    return codes;
}();

// The last code whose base is not above the value.
template <std::size_t count>
unsigned code_of(const std::array<Code, count>& codes, std::size_t value) {
    const auto above = std::ranges::upper_bound(codes, value, {}, &Code::base);
    return static_cast<unsigned>(above - codes.begin()) - 1;
}

void put_extra(BitWriter& bits, const Code& code, std::size_t value) {
    bits.put(static_cast<std::uint32_t>(value - code.base), code.extra);
}

// The same bytes as `distance` before.
struct Match {
    std::size_t length = 0;
    std::size_t distance = 0;
};

void put_match(BitWriter& bits, const Match& match) {
    const unsigned length_code = code_of(length_codes, match.length);
    put_literal_or_length_code(bits, 257 + length_code);
    put_extra(bits, length_codes[length_code], match.length);
    const unsigned distance_code = code_of(distance_codes, match.distance);
    bits.put_code(distance_code, 5);
    put_extra(bits, distance_codes[distance_code], match.distance);
}

// Where four bytes with the same hash stood last.
class MatchFinder {
  public:
    explicit MatchFinder(ByteSpan data) : data_(data), last_at_(1 << hash_bits, nowhere) {}

    // A match of at least four bytes; keeps `at` for later ones.
    std::optional<Match> find(std::size_t at) {
        if (at + 4 > data_.size())
            return std::nullopt;
        std::size_t& entry = last_at_[hash_at(at)];
        const std::size_t earlier = entry;
        entry = at;
        if (earlier == nowhere || at - earlier > max_distance)
            return std::nullopt;
        const std::size_t length = common_length(earlier, at);
        if (length < 4)
            return std::nullopt;
        return Match{length, at - earlier};
    }

  private:
    static constexpr unsigned hash_bits = 15;
    static constexpr std::size_t nowhere = SIZE_MAX;

    [[nodiscard]] std::uint32_t hash_at(std::size_t at) const {
        std::uint32_t word = 0;
        for (unsigned k = 0; k < 4; ++k)
            word |= std::uint32_t{data_[at + k]} << (8 * k);
        return (word * 2654435761u) >> (32 - hash_bits);
    }
    [[nodiscard]] std::size_t common_length(std::size_t earlier, std::size_t at) const {
        const std::size_t limit = std::min(max_length, data_.size() - at);
        std::size_t length = 0;
        while (length < limit && data_[earlier + length] == data_[at + length])
            ++length;
        return length;
    }

    ByteSpan data_;
    std::vector<std::size_t> last_at_;
};

void put_block(BitWriter& bits, ByteSpan data) {
    constexpr unsigned end_of_block = 256;
    bits.put(1, 1);  // the last block
    bits.put(1, 2);  // with the fixed codes
    MatchFinder finder(data);
    for (std::size_t at = 0; at < data.size();) {
        if (const auto match = finder.find(at)) {
            put_match(bits, *match);
            at += match->length;
        } else {
            put_literal_or_length_code(bits, data[at]);
            ++at;
        }
    }
    put_literal_or_length_code(bits, end_of_block);
    bits.flush();
}

std::uint32_t adler32(ByteSpan data) {
    constexpr std::uint32_t modulus = 65521;
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const std::uint8_t byte : data) {
        a = (a + byte) % modulus;
        b = (b + a) % modulus;
    }
    return b << 16 | a;
}

}  // namespace

void append_be32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
    for (unsigned shift : {24u, 16u, 8u, 0u})
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::vector<std::uint8_t> compress_zlib(std::span<const std::uint8_t> data) {
    Bytes out = {0x78, 0x01};
    BitWriter bits(out);
    put_block(bits, data);
    append_be32(out, adler32(data));
    return out;
}

}  // namespace drtv::tool
