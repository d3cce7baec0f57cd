#include "client/gltf_references.h"

#include "map_files/reference.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint32_t json_chunk = 0x4E4F534A;

// The JSON text of a .gltf or of a .glb's first chunk; empty when there is none to find.
std::string document_text(const fs::path& path) {
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

}  // namespace

std::vector<std::string> outside_uris(const fs::path& document) {
    std::vector<std::string> found;
    const Json root = Json::parse(document_text(document), nullptr, false);
    if (!root.is_object())
        return found;
    for (const char* list : {"buffers", "images"}) {
        const auto elements = root.find(list);
        if (elements == root.end() || !elements->is_array())
            continue;
        for (const Json& element : *elements) {
            const auto uri = element.is_object() ? element.find("uri") : element.end();
            if (uri == element.end() || !uri->is_string())
                continue;
            const auto& text = uri->get_ref<const std::string&>();
            if (!map_files::is_data_uri(text))
                found.push_back(text);
        }
    }
    return found;
}

}  // namespace drtv::client
