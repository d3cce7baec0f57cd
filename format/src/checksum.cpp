#include "checksum.h"

#include "bytes.h"

#include <bit>

namespace drtv {
namespace {

constexpr std::uint64_t prime1 = 0x9E3779B185EBCA87u, prime2 = 0xC2B2AE3D27D4EB4Fu,
                        prime3 = 0x165667B19E3779F9u, prime4 = 0x85EBCA77C2B2AE63u,
                        prime5 = 0x27D4EB2F165667C5u;

constexpr std::uint64_t round(std::uint64_t lane, std::uint64_t input) {
    return std::rotl(lane + input * prime2, 31) * prime1;
}

constexpr std::uint64_t merge(std::uint64_t hash, std::uint64_t lane) {
    return (hash ^ round(0, lane)) * prime1 + prime4;
}

}  // namespace

std::uint64_t xxh64(std::span<const std::uint8_t> bytes) {
    std::size_t at = 0;
    std::uint64_t hash = prime5;
    if (bytes.size() >= 32) {
        std::uint64_t a = prime1 + prime2, b = prime2, c = 0, d = 0 - prime1;
        for (; at + 32 <= bytes.size(); at += 32) {
            a = round(a, load_u64(bytes, at));
            b = round(b, load_u64(bytes, at + 8));
            c = round(c, load_u64(bytes, at + 16));
            d = round(d, load_u64(bytes, at + 24));
        }
        hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
        hash = merge(merge(merge(merge(hash, a), b), c), d);
    }
    hash += bytes.size();
    for (; at + 8 <= bytes.size(); at += 8) {
        hash = std::rotl(hash ^ round(0, load_u64(bytes, at)), 27) * prime1 + prime4;
    }
    if (at + 4 <= bytes.size()) {
        hash = std::rotl(hash ^ load_u32(bytes, at) * prime1, 23) * prime2 + prime3;
        at += 4;
    }
    for (; at < bytes.size(); ++at)
        hash = std::rotl(hash ^ bytes[at] * prime5, 11) * prime1;
    hash = (hash ^ (hash >> 33)) * prime2;
    hash = (hash ^ (hash >> 29)) * prime3;
    return hash ^ (hash >> 32);
}

}  // namespace drtv
