#include "bakerd/map/glb.h"

#include <fmt/format.h>

namespace drtv::map {
namespace {

constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;

constexpr std::size_t header_bytes = 12;
constexpr std::size_t chunk_header_bytes = 8;

std::uint32_t load_u32(const FileBytes& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;)
        value = value << 8 | bytes[at + k];
    return value;
}

// The header, and that the first chunk is there and holds JSON. Gives the length of the GLB: what follows is
// not part of it.
tl::expected<std::size_t, std::string> check_header(const FileBytes& bytes) {
    constexpr std::size_t min_bytes = header_bytes + chunk_header_bytes;
    if (bytes.size() < min_bytes)
        return tl::unexpected(fmt::format("a GLB file has at least 20 bytes, it has {}", bytes.size()));
    const std::uint32_t version = load_u32(bytes, 4);
    if (version != 2)
        return tl::unexpected(fmt::format("it is GLB version {}, only 2 is supported", version));
    const std::size_t length = load_u32(bytes, 8);
    if (length < min_bytes || length > bytes.size())
        return tl::unexpected(fmt::format("its GLB header says {} bytes, it has {}", length, bytes.size()));
    if (load_u32(bytes, 16) != json_chunk)
        return tl::unexpected(std::string("its first GLB chunk is not JSON"));
    return length;
}

}  // namespace

tl::expected<GlbChunks, std::string> glb_chunks(const FileBytes& bytes) {
    const auto length = check_header(bytes);
    if (!length)
        return tl::unexpected(length.error());
    GlbChunks chunks;
    for (std::size_t at = header_bytes; at < *length;) {
        const std::size_t left = *length - at;
        if (left < chunk_header_bytes)
            return tl::unexpected(fmt::format("the GLB chunk header at byte {} is cut off", at));
        const std::size_t size = load_u32(bytes, at);
        const std::uint32_t type = load_u32(bytes, at + 4);
        const std::size_t begin = at + chunk_header_bytes;
        if (size > *length - begin)
            return tl::unexpected(fmt::format(
                "the GLB chunk at byte {} ends at {}, the GLB has {} bytes", at, begin + size, *length));
        const bool second_json = type == json_chunk && at > header_bytes;
        const bool second_binary = type == binary_chunk && chunks.binary;
        if (second_json || second_binary)
            return tl::unexpected(fmt::format("the GLB chunk at byte {} stands twice", at));
        const std::span chunk = std::span(bytes).subspan(begin, size);
        if (type == json_chunk)
            chunks.json = {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
        if (type == binary_chunk)
            chunks.binary = chunk;
        at = begin + size;
    }
    return chunks;
}

}  // namespace drtv::map
