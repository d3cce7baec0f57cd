#include "png_writer.h"

#include "zlib_stream.h"

#include <span>
#include <string_view>

namespace drtv::tool {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Of the PNG specification, annex D.
std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
    std::uint32_t crc = 0xFFFFFFFFu;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int k = 0; k < 8; ++k) {
            const std::uint32_t all_if_odd = 0u - (crc & 1u);
            crc = (crc >> 1) ^ (0xEDB88320u & all_if_odd);
        }
    }
    return ~crc;
}

void append_chunk(Bytes& out, std::string_view type, const Bytes& content) {
    append_be32(out, static_cast<std::uint32_t>(content.size()));
    const std::size_t start = out.size();
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), content.begin(), content.end());
    append_be32(out, crc32(std::span(out).subspan(start)));
}

// Each row as differences to the pixel on its left (filter type 1): smooth pictures become small numbers.
Bytes filter_rows(const Image& image) {
    const std::size_t row_bytes = image.width * 3;
    Bytes rows;
    rows.reserve(image.height * (row_bytes + 1));
    for (std::size_t y = 0; y < image.height; ++y) {
        rows.push_back(1);
        const std::uint8_t* row = image.rgb.data() + y * row_bytes;
        for (std::size_t k = 0; k < row_bytes; ++k) {
            const int left = k < 3 ? 0 : row[k - 3];
            rows.push_back(static_cast<std::uint8_t>(row[k] - left));
        }
    }
    return rows;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
    constexpr std::uint8_t bit_depth = 8;
    constexpr std::uint8_t colour_type_rgb = 2;
    Bytes header;
    append_be32(header, static_cast<std::uint32_t>(image.width));
    append_be32(header, static_cast<std::uint32_t>(image.height));
    header.push_back(bit_depth);
    header.push_back(colour_type_rgb);
    header.insert(header.end(), 3, 0);  // the only compression and filter methods, not interlaced

    Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    append_chunk(out, "IHDR", header);
    append_chunk(out, "IDAT", compress_zlib(filter_rows(image)));
    append_chunk(out, "IEND", {});
    return out;
}

}  // namespace drtv::tool
