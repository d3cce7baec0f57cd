// A zlib stream (RFC 1950) of one deflate block with the fixed Huffman codes (RFC 1951). Written here because
// format/ may depend on zstd only; it is enough for pictures of a few megapixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace drtv::tool {

[[nodiscard]] std::vector<std::uint8_t> compress_zlib(std::span<const std::uint8_t> data);

// The high byte first, as zlib and PNG write their numbers.
void append_be32(std::vector<std::uint8_t>& bytes, std::uint32_t value);

}  // namespace drtv::tool
