#include "bakerd/map/digest.h"

#include <openssl/evp.h>

#include <new>

namespace drtv::map {

std::string to_hex(const Digest& digest) {
    static constexpr char digits[] = "0123456789abcdef";
    std::string hex;
    for (std::uint8_t byte : digest.bytes) {
        hex += digits[byte >> 4];
        hex += digits[byte & 15];
    }
    return hex;
}

std::optional<Digest> digest_from_hex(std::string_view hex) {
    Digest digest;
    if (hex.size() != 2 * digest.bytes.size())
        return std::nullopt;
    for (std::size_t n = 0; n < hex.size(); ++n) {
        const char c = hex[n];
        int nibble = 0;
        if (c >= '0' && c <= '9')
            nibble = c - '0';
        else if (c >= 'a' && c <= 'f')
            nibble = c - 'a' + 10;
        else
            return std::nullopt;
        std::uint8_t& byte = digest.bytes[n / 2];
        byte = static_cast<std::uint8_t>(byte << 4 | nibble);
    }
    return digest;
}

Digest digest_of(std::span<const std::uint8_t> bytes) {
    Hasher hasher;
    hasher.add_bytes(bytes.data(), bytes.size());
    return hasher.finish();
}

struct Hasher::State {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    ~State() { EVP_MD_CTX_free(context); }
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
    // SHA-256 is always there; only memory can fail here.
    if (state_->context == nullptr || EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr) != 1)
        throw std::bad_alloc();
}

Hasher::~Hasher() = default;

void Hasher::add_bytes(const void* data, std::size_t size) {
    if (size > 0)
        EVP_DigestUpdate(state_->context, data, size);
}

Digest Hasher::finish() {
    Digest digest;
    EVP_DigestFinal_ex(state_->context, digest.bytes.data(), nullptr);
    return digest;
}

}  // namespace drtv::map
