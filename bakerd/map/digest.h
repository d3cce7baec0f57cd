// SHA-256 digests: names of blobs, of map content, of results.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace drtv::map {

struct Digest {
    std::array<std::uint8_t, 32> bytes{};
    auto operator<=>(const Digest&) const = default;
};

[[nodiscard]] std::string to_hex(const Digest& digest);                     // 64 lower-case digits
[[nodiscard]] std::optional<Digest> digest_from_hex(std::string_view hex);  // nothing unless exactly that

// Digest of one run of bytes.
[[nodiscard]] Digest digest_of(std::span<const std::uint8_t> bytes);

// Digest of several parts. Variable-length parts must be preceded by their length, so that no two different
// sequences give the same bytes; add_sized does.
class Hasher {
  public:
    Hasher();
    ~Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    void add_bytes(const void* data, std::size_t size);

    // The object representation: for integers, floats and padding-free structs of them. -0.0f and 0.0f
    // differ.
    template <class Value>
    requires std::is_trivially_copyable_v<Value>
    void add(const Value& value) { add_bytes(&value, sizeof value); }

    template <class Range>
    void add_sized(const Range& range) {
        add(static_cast<std::uint64_t>(range.size()));
        add_bytes(range.data(), range.size() * sizeof(*range.data()));
    }

    [[nodiscard]] Digest finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace drtv::map
