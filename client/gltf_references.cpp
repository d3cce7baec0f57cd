#include "client/gltf_references.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint32_t json_chunk = 0x4E4F534A;

// The JSON text of a .gltf or of a .glb's first chunk; empty when there is none to find.
std::string document_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 20> head{};
    file.read(head.data(), head.size());
    const bool is_glb = file.gcount() == 20 && std::memcmp(head.data(), "glTF", 4) == 0;
    if (!is_glb) {
        file.clear();
        file.seekg(0);
        return std::string(std::istreambuf_iterator<char>(file), {});
    }
    std::uint32_t size = 0;
    std::uint32_t type = 0;
    std::memcpy(&size, head.data() + 12, 4);
    std::memcpy(&type, head.data() + 16, 4);
    std::error_code code;
    if (type != json_chunk || size > fs::file_size(path, code))
        return "";
    std::string text(size, '\0');
    file.read(text.data(), static_cast<std::streamsize>(size));
    return text;
}

bool is_hex_digit(char c) {
    return std::isxdigit(static_cast<unsigned char>(c)) != 0;
}

// What is no %xx stays as it is.
std::string decode_uri(const std::string& uri) {
    std::string decoded;
    for (std::size_t n = 0; n < uri.size(); ++n) {
        const bool has_room = uri[n] == '%' && n + 2 < uri.size();
        const bool is_escape = has_room && is_hex_digit(uri[n + 1]) && is_hex_digit(uri[n + 2]);
        if (!is_escape) {
            decoded += uri[n];
            continue;
        }
        const std::string digits = uri.substr(n + 1, 2);
        decoded += static_cast<char>(std::stoi(digits, nullptr, 16));
        n += 2;
    }
    return decoded;
}

// Below the document's own folder, without tricks; the rest is the server's to refuse.
bool is_plain(const std::string& path) {
    if (path.empty() || path.front() == '/' || path.find('\0') != std::string::npos)
        return false;
    const fs::path parts(path);
    const auto leads_up = [](const fs::path& part) { return part == ".."; };
    return std::none_of(parts.begin(), parts.end(), leads_up);
}

// The path of a buffer or an image that lies in a file of its own.
std::optional<std::string> referenced_file(const Json& element) {
    if (!element.is_object())
        return std::nullopt;
    const auto uri = element.find("uri");
    if (uri == element.end() || !uri->is_string())
        return std::nullopt;
    const auto& text = uri->get_ref<const std::string&>();
    if (text.starts_with("data:"))
        return std::nullopt;
    std::string path = decode_uri(text);
    if (!is_plain(path))
        return std::nullopt;
    return path;
}

}  // namespace

std::vector<std::string> referenced_files(const std::string& gltf_path) {
    std::vector<std::string> found;
    const Json root = Json::parse(document_text(gltf_path), nullptr, false);
    if (!root.is_object())
        return found;
    for (const char* list : {"buffers", "images"}) {
        const auto elements = root.find(list);
        if (elements == root.end() || !elements->is_array())
            continue;
        for (const Json& element : *elements) {
            if (auto path = referenced_file(element))
                found.push_back(std::move(*path));
        }
    }
    return found;
}

}  // namespace drtv::client
