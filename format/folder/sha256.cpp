#include "sha256.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

namespace drtv::folder {
namespace {

class Sha256 {
  public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
    }

    void add(const char* data, std::size_t size) { EVP_DigestUpdate(context_.get(), data, size); }

    [[nodiscard]] std::string hex() {
        std::array<unsigned char, 32> digest{};
        EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
        constexpr const char* digits = "0123456789abcdef";
        std::string text;
        for (unsigned char byte : digest) {
            text += digits[byte >> 4];
            text += digits[byte & 15];
        }
        return text;
    }

  private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

cli::Result<std::string> sha256_of_file(const std::string& path) {
    const auto fail = [&] {
        return cli::fail(cli::exit_unreadable, "cannot read " + path + ": " + std::strerror(errno));
    };
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return fail();
    Sha256 hash;
    std::vector<char> buffer(1 << 20);
    const auto buffer_size = static_cast<std::streamsize>(buffer.size());
    while (file.read(buffer.data(), buffer_size) || file.gcount() > 0)
        hash.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (file.bad())
        return fail();
    return hash.hex();
}

std::string sha256_of_text(std::string_view bytes) {
    Sha256 hash;
    hash.add(bytes.data(), bytes.size());
    return hash.hex();
}

}  // namespace drtv::folder
