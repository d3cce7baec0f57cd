// XXH64 with seed 0, as the xxHash specification defines it (Cyan4973/xxHash, doc/xxhash_spec.md). Written
// here because format/ may depend on zstd only, which keeps its own copy private.
#pragma once

#include <cstdint>
#include <span>

namespace drtv {

[[nodiscard]] std::uint64_t xxh64(std::span<const std::uint8_t> bytes);

}  // namespace drtv
