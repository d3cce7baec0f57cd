#include "client/map_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint32_t json_chunk = 0x4E4F534A;

class Sha256 {
  public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
    }
    void add(const char* data, std::size_t size) { EVP_DigestUpdate(context_.get(), data, size); }
    [[nodiscard]] std::string hex() {
        std::array<unsigned char, 32> digest{};
        EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
        std::string text;
        for (unsigned char byte : digest)
            text += fmt::format("{:02x}", byte);
        return text;
    }

  private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

// The JSON text of a .gltf or of a .glb's first chunk; empty when there is none to find.
std::string document_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 20> head{};
    file.read(head.data(), head.size());
    std::uint32_t size = 0, type = 0;
    std::memcpy(&size, head.data() + 12, 4);
    std::memcpy(&type, head.data() + 16, 4);
    if (file.gcount() == 20 && std::memcmp(head.data(), "glTF", 4) == 0) {
        std::error_code code;
        if (type != json_chunk || size > fs::file_size(path, code))
            return "";
        std::string text(size, '\0');
        file.read(text.data(), static_cast<std::streamsize>(size));
        return text;
    }
    file.clear();
    file.seekg(0);
    return std::string(std::istreambuf_iterator<char>(file), {});
}

std::string decode_uri(const std::string& uri) {
    std::string decoded;
    for (std::size_t n = 0; n < uri.size(); ++n) {
        const bool escape = uri[n] == '%' && n + 2 < uri.size() &&
                            std::isxdigit(static_cast<unsigned char>(uri[n + 1])) &&
                            std::isxdigit(static_cast<unsigned char>(uri[n + 2]));
        if (escape) {
            decoded += static_cast<char>(std::stoi(uri.substr(n + 1, 2), nullptr, 16));
            n += 2;
        } else {
            decoded += uri[n];
        }
    }
    return decoded;
}

// Below the document's own folder, without tricks; the rest is the server's to refuse.
bool is_plain(const std::string& path) {
    if (path.empty() || path.front() == '/' || path.find('\0') != std::string::npos)
        return false;
    const fs::path parts(path);
    return std::none_of(parts.begin(), parts.end(), [](const fs::path& part) { return part == ".."; });
}

std::vector<std::string> external_files(const std::string& path) {
    std::vector<std::string> found;
    const Json root = Json::parse(document_text(path), nullptr, false);
    if (!root.is_object())
        return found;
    for (const char* list : {"buffers", "images"}) {
        const auto elements = root.find(list);
        if (elements == root.end() || !elements->is_array())
            continue;
        for (const Json& element : *elements) {
            const auto uri = element.is_object() ? element.find("uri") : element.end();
            if (!element.is_object() || uri == element.end() || !uri->is_string())
                continue;
            const auto& text = uri->get_ref<const std::string&>();
            if (!text.starts_with("data:") && is_plain(decode_uri(text)))
                found.push_back(decode_uri(text));
        }
    }
    return found;
}

tl::expected<std::vector<fs::path>, std::string> find_roots(const std::vector<std::string>& arguments) {
    std::vector<fs::path> roots;
    for (const std::string& argument : arguments) {
        std::error_code code;
        const fs::path path = fs::weakly_canonical(fs::absolute(argument, code), code);
        if (!fs::exists(path, code))
            return tl::unexpected(fmt::format("the map {} does not exist", argument));
        if (!fs::is_directory(path, code)) {
            // A pipe or a device would never end.
            if (!fs::is_regular_file(path, code))
                return tl::unexpected(fmt::format("the map {} is not a regular file", argument));
            roots.push_back(path);
            continue;
        }
        const std::size_t before = roots.size();
        for (const auto& entry : fs::directory_iterator(path, code)) {
            const bool named_so = entry.path().extension() == ".glb" || entry.path().extension() == ".gltf";
            if (named_so && fs::is_regular_file(entry.path(), code))
                roots.push_back(entry.path());
        }
        if (code)
            return tl::unexpected(fmt::format("cannot read the folder {}: {}", argument, code.message()));
        if (roots.size() == before)
            return tl::unexpected(fmt::format("the folder {} holds no .glb or .gltf file", argument));
    }
    std::sort(roots.begin(), roots.end());
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    return roots;
}

fs::path common_folder(const std::vector<fs::path>& roots) {
    fs::path common = roots.front().parent_path();
    for (const fs::path& root : roots) {
        while (!root.parent_path().lexically_relative(common).empty() &&
               *root.parent_path().lexically_relative(common).begin() == "..")
            common = common.parent_path();
    }
    return common;
}

}  // namespace

std::string sha256_of_text(const std::string& bytes) {
    Sha256 hash;
    hash.add(bytes.data(), bytes.size());
    return hash.hex();
}

tl::expected<std::string, std::string> sha256_of_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return tl::unexpected(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
    Sha256 hash;
    std::vector<char> buffer(1 << 20);
    while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || file.gcount() > 0)
        hash.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (file.bad())
        return tl::unexpected(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
    return hash.hex();
}

tl::expected<LocalMap, std::string> collect_map(const std::vector<std::string>& arguments) {
    const auto roots = find_roots(arguments);
    if (!roots)
        return tl::unexpected(roots.error());
    const fs::path folder = common_folder(*roots);
    LocalMap map;
    std::set<fs::path> paths;
    for (const fs::path& root : *roots) {
        map.roots.push_back(root.lexically_relative(folder).generic_string());
        paths.insert(root);
        for (const std::string& external : external_files(root.string())) {
            std::error_code code;
            const fs::path path = (root.parent_path() / external).lexically_normal();
            if (fs::is_regular_file(path, code))
                paths.insert(path);
        }
    }
    for (const fs::path& path : paths) {
        auto digest = sha256_of_file(path.string());
        if (!digest)
            return tl::unexpected(digest.error());
        std::error_code code;
        map.files.push_back({path.string(),
                             path.lexically_relative(folder).generic_string(),
                             *digest,
                             static_cast<std::int64_t>(fs::file_size(path, code))});
    }
    return map;
}

tl::expected<void, std::string> write_whole(const std::string& path, const std::string& bytes) {
    const std::string temporary = fmt::format("{}.part{}", path, ::getpid());
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    bool written = fd >= 0;
    for (std::size_t at = 0; written && at < bytes.size();) {
        const ssize_t n = ::write(fd, bytes.data() + at, bytes.size() - at);
        if (n < 0 && errno == EINTR)
            continue;
        written = n > 0;
        if (n > 0)
            at += static_cast<std::size_t>(n);
    }
    const int write_error = errno;
    if (fd >= 0 && ::close(fd) != 0)
        written = false;
    if (written && ::rename(temporary.c_str(), path.c_str()) == 0)
        return {};
    const int error = written || fd < 0 ? errno : write_error;
    if (fd >= 0)
        ::unlink(temporary.c_str());
    return tl::unexpected(fmt::format("cannot write {}: {}", path, std::strerror(error)));
}

}  // namespace drtv::client
