#include "png_writer.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace drtv::tool {
namespace {

using Bytes = std::vector<std::uint8_t>;

class BitWriter {
  public:
    explicit BitWriter(Bytes& out) : out_(out) {}

    void put(std::uint32_t bits, unsigned count) {  // least significant bit first
        held_ |= std::uint64_t{bits} << held_count_;
        for (held_count_ += count; held_count_ >= 8; held_count_ -= 8, held_ >>= 8)
            out_.push_back(static_cast<std::uint8_t>(held_));
    }
    void put_code(std::uint32_t code, unsigned count) {  // Huffman codes go most significant bit first
        std::uint32_t reversed = 0;
        for (unsigned k = 0; k < count; ++k)
            reversed |= ((code >> k) & 1u) << (count - 1 - k);
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

constexpr std::array<std::uint16_t, 29> length_base = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                                       15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                                       67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr std::array<std::uint8_t, 29> length_extra = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                                       2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
constexpr std::array<std::uint16_t, 30> distance_base = {
    1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
    193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};

template <std::size_t N>
unsigned last_not_above(const std::array<std::uint16_t, N>& base, std::size_t value) {
    return static_cast<unsigned>(std::upper_bound(base.begin(), base.end(), value) - base.begin()) - 1;
}

void put_match(BitWriter& bits, std::size_t length, std::size_t distance) {
    const unsigned l = last_not_above(length_base, length);
    put_literal_or_length_code(bits, 257 + l);
    bits.put(static_cast<std::uint32_t>(length - length_base[l]), length_extra[l]);
    const unsigned d = last_not_above(distance_base, distance);
    bits.put_code(d, 5);
    bits.put(static_cast<std::uint32_t>(distance - distance_base[d]), d < 2 ? 0 : d / 2 - 1);
}

Bytes deflate_fixed(const Bytes& data) {
    constexpr std::size_t window = 32768, max_length = 258;
    Bytes out = {0x78, 0x01};
    BitWriter bits(out);
    bits.put(1, 1);
    bits.put(1, 2);
    std::vector<std::size_t> last_at(1 << 15, SIZE_MAX);
    for (std::size_t at = 0; at < data.size();) {
        std::size_t length = 0, distance = 0;
        if (at + 4 <= data.size()) {
            const std::uint32_t word = data[at] | std::uint32_t{data[at + 1]} << 8 |
                                       std::uint32_t{data[at + 2]} << 16 | std::uint32_t{data[at + 3]} << 24;
            std::size_t& entry = last_at[(word * 2654435761u) >> 17];
            if (entry != SIZE_MAX && at - entry <= window) {
                distance = at - entry;
                const std::size_t limit = std::min(max_length, data.size() - at);
                while (length < limit && data[entry + length] == data[at + length])
                    ++length;
            }
            entry = at;
        }
        if (length >= 4) {
            put_match(bits, length, distance);
            at += length;
        } else {
            put_literal_or_length_code(bits, data[at++]);
        }
    }
    put_literal_or_length_code(bits, 256);
    bits.flush();
    std::uint32_t a = 1, b = 0;  // Adler-32
    for (std::uint8_t byte : data) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    for (unsigned shift : {24u, 16u, 8u, 0u})
        out.push_back(static_cast<std::uint8_t>((b << 16 | a) >> shift));
    return out;
}

std::uint32_t crc32(const std::uint8_t* data, std::size_t size) {
    std::uint32_t crc = 0xFFFFFFFFu;
    for (std::size_t n = 0; n < size; ++n) {
        crc ^= data[n];
        for (int k = 0; k < 8; ++k)
            crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
    }
    return ~crc;
}

void append_be32(Bytes& out, std::uint32_t value) {
    for (unsigned shift : {24u, 16u, 8u, 0u})
        out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(Bytes& out, std::string_view type, const Bytes& content) {
    append_be32(out, static_cast<std::uint32_t>(content.size()));
    const std::size_t start = out.size();
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), content.begin(), content.end());
    append_be32(out, crc32(&out[start], out.size() - start));
}

// Each row as differences to the pixel on its left (filter type 1): smooth pictures become small numbers.
Bytes filter_rows(const Image& image) {
    Bytes rows;
    rows.reserve(image.height * (image.width * 3 + 1));
    for (std::size_t y = 0; y < image.height; ++y) {
        rows.push_back(1);
        const std::uint8_t* row = &image.rgb[y * image.width * 3];
        for (std::size_t k = 0; k < image.width * 3; ++k) {
            rows.push_back(static_cast<std::uint8_t>(row[k] - (k < 3 ? 0 : row[k - 3])));
        }
    }
    return rows;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
    Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    Bytes header;
    append_be32(header, static_cast<std::uint32_t>(image.width));
    append_be32(header, static_cast<std::uint32_t>(image.height));
    for (int byte : {8, 2, 0, 0, 0})
        header.push_back(static_cast<std::uint8_t>(byte));
    append_chunk(out, "IHDR", header);
    append_chunk(out, "IDAT", deflate_fixed(filter_rows(image)));
    append_chunk(out, "IEND", {});
    return out;
}

}  // namespace drtv::tool
