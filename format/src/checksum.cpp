#include "checksum.h"

#include "bytes.h"

#include <bit>

namespace drtv {
namespace {

constexpr std::uint64_t prime1 = 0x9E3779B185EBCA87u;
constexpr std::uint64_t prime2 = 0xC2B2AE3D27D4EB4Fu;
constexpr std::uint64_t prime3 = 0x165667B19E3779F9u;
constexpr std::uint64_t prime4 = 0x85EBCA77C2B2AE63u;
constexpr std::uint64_t prime5 = 0x27D4EB2F165667C5u;

constexpr std::size_t stripe_bytes = 32;

constexpr std::uint64_t round(std::uint64_t lane, std::uint64_t input) {
    return std::rotl(lane + input * prime2, 31) * prime1;
}

constexpr std::uint64_t merge(std::uint64_t hash, std::uint64_t lane) {
    return (hash ^ round(0, lane)) * prime1 + prime4;
}

// Four lanes over the whole stripes, then one number from the four. REQUIRES: at least one stripe.
std::uint64_t hash_stripes(ByteSpan stripes) {
    std::uint64_t a = prime1 + prime2;
    std::uint64_t b = prime2;
    std::uint64_t c = 0;
    std::uint64_t d = 0 - prime1;
    for (std::size_t at = 0; at < stripes.size(); at += stripe_bytes) {
        a = round(a, load_u64(stripes, at));
        b = round(b, load_u64(stripes, at + 8));
        c = round(c, load_u64(stripes, at + 16));
        d = round(d, load_u64(stripes, at + 24));
    }
    std::uint64_t hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
    hash = merge(hash, a);
    hash = merge(hash, b);
    hash = merge(hash, c);
    return merge(hash, d);
}

// What is left behind the stripes: by eight bytes, then four, then one.
std::uint64_t add_rest(std::uint64_t hash, ByteSpan rest) {
    std::size_t at = 0;
    for (; at + 8 <= rest.size(); at += 8) {
        hash ^= round(0, load_u64(rest, at));
        hash = std::rotl(hash, 27) * prime1 + prime4;
    }
    if (at + 4 <= rest.size()) {
        hash ^= load_u32(rest, at) * prime1;
        hash = std::rotl(hash, 23) * prime2 + prime3;
        at += 4;
    }
    for (; at < rest.size(); ++at) {
        hash ^= rest[at] * prime5;
        hash = std::rotl(hash, 11) * prime1;
    }
    return hash;
}

// Every bit of the number changes about half of those of the hash.
constexpr std::uint64_t mix(std::uint64_t hash) {
    hash ^= hash >> 33;
    hash *= prime2;
    hash ^= hash >> 29;
    hash *= prime3;
    return hash ^ (hash >> 32);
}

}  // namespace

std::uint64_t xxh64(std::span<const std::uint8_t> bytes) {
    const std::size_t rest_bytes = bytes.size() % stripe_bytes;
    const ByteSpan stripes = bytes.first(bytes.size() - rest_bytes);
    std::uint64_t hash = stripes.empty() ? prime5 : hash_stripes(stripes);
    hash += bytes.size();
    return mix(add_rest(hash, bytes.last(rest_bytes)));
}

}  // namespace drtv
