#include "bakerd/reuse/record_bytes.h"

#include <zstd.h>

namespace drtv::reuse {
namespace {

constexpr int compression_level = 9;
constexpr std::uint64_t max_bytes = std::uint64_t{1} << 32;  // of a record: far above any

}  // namespace

std::vector<std::uint8_t> RecordWriter::compressed() const {
    std::vector<std::uint8_t> packed(ZSTD_compressBound(bytes_.size()));
    packed.resize(
        ZSTD_compress(packed.data(), packed.size(), bytes_.data(), bytes_.size(), compression_level));
    return packed;
}

RecordReader::RecordReader(std::span<const std::uint8_t> compressed) {
    const unsigned long long size = ZSTD_getFrameContentSize(compressed.data(), compressed.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > max_bytes)
        return;
    bytes_.resize(size);
    sound_ = ZSTD_decompress(bytes_.data(), bytes_.size(), compressed.data(), compressed.size()) == size;
}

}  // namespace drtv::reuse
