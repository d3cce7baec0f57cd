#include "bakerd/map/gltf_document.h"

#include "bakerd/map/document_check.h"

#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <string_view>

namespace drtv::map {
namespace {

constexpr std::size_t max_file_bytes = std::size_t{1} << 31;

std::uint32_t load_u32(const FileBytes& bytes, std::size_t at) {
    return bytes[at] | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16 | std::uint32_t{bytes[at + 3]} << 24;
}

// The JSON of a GLB, with its framing checked (glTF 2.0, section 4).
tl::expected<std::string_view, std::string> glb_json(const FileBytes& bytes) {
    if (bytes.size() < 20) return tl::unexpected(fmt::format("a GLB file has at least 20 bytes, it has {}", bytes.size()));
    if (load_u32(bytes, 4) != 2) return tl::unexpected(fmt::format("it is GLB version {}, only 2 is supported", load_u32(bytes, 4)));
    if (load_u32(bytes, 8) != bytes.size()) return tl::unexpected(fmt::format("its GLB header says {} bytes, it has {}", load_u32(bytes, 8), bytes.size()));
    constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
    if (load_u32(bytes, 16) != json_chunk) return tl::unexpected(std::string("its first GLB chunk is not JSON"));
    bool binary_seen = false;
    for (std::size_t at = 12; at < bytes.size();) {
        if (bytes.size() - at < 8) return tl::unexpected(fmt::format("the GLB chunk header at byte {} is cut off", at));
        const std::uint32_t size = load_u32(bytes, at), type = load_u32(bytes, at + 4);
        if (size > bytes.size() - at - 8) return tl::unexpected(fmt::format("the GLB chunk at byte {} ends at {}, the file has {} bytes", at, at + 8 + std::uint64_t{size}, bytes.size()));
        if (at > 12 && (type == json_chunk || (type == binary_chunk && binary_seen))) return tl::unexpected(fmt::format("the GLB chunk at byte {} stands twice", at));
        binary_seen = binary_seen || type == binary_chunk;
        at += 8 + std::size_t{size};
    }
    return std::string_view(reinterpret_cast<const char*>(&bytes[20]), load_u32(bytes, 12));
}

// tinygltf's callbacks over a FileSource, relative to the document's folder.
struct FileAccess {
    const FileSource* files;
    std::string folder;  // with a slash at its end, or empty
    std::string missing;  // the first sentence of a file that could not be read
};

bool file_exists(const std::string&, void*) { return true; }
std::string keep_path(const std::string& path, void*) { return path; }
bool refuse_write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

bool read_whole(std::vector<unsigned char>* out, std::string*, const std::string& path, void* user) {
    auto& access = *static_cast<FileAccess*>(user);
    // tinygltf puts "./" before a path without folder.
    const std::string name = path.starts_with("./") ? path.substr(2) : path;
    auto bytes = (*access.files)(access.folder + name);
    if (!bytes) {
        if (access.missing.empty()) access.missing = bytes.error();
        return false;
    }
    *out = std::move(*bytes);
    return true;
}

bool keep_encoded_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes, int size, void*) {
    image->image.assign(bytes, bytes + size);
    return true;
}

std::string first_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    for (char& c : text) {
        if (c == '\n') c = ' ';
    }
    return text.substr(0, 300);
}

}  // namespace

tl::expected<GltfDocument, std::string> load_document(const std::string& path, const FileSource& files) {
    GltfDocument document;
    document.path = path;
    auto bytes = files(path);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto fail = [&](const std::string& rest) { return tl::unexpected(document.at(rest)); };
    if (bytes->size() > max_file_bytes) return fail(fmt::format("it has {} bytes, over the limit of 2 GiB", bytes->size()));

    const bool binary = bytes->size() >= 4 && std::memcmp(bytes->data(), "glTF", 4) == 0;
    std::string_view json(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (binary) {
        const auto chunk = glb_json(*bytes);
        if (!chunk) return fail(chunk.error());
        json = *chunk;
    }
    if (json.find_first_not_of(" \t\r\n") == std::string_view::npos || json[json.find_first_not_of(" \t\r\n")] != '{') {
        return fail("it is not a glTF file: it begins neither with JSON nor with a GLB header");
    }
    const auto summary = check_document(json);
    if (!summary) return fail(summary.error());

    FileAccess access{&files, path.find('/') == std::string::npos ? "" : path.substr(0, path.rfind('/') + 1), ""};
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded_image, nullptr);
    loader.SetFsCallbacks({file_exists, keep_path, read_whole, refuse_write, &access});
    std::string error, warning;
    bool loaded = false;
    try {
        const auto size = static_cast<unsigned>(bytes->size());
        loaded = binary ? loader.LoadBinaryFromMemory(&document.model, &error, &warning, bytes->data(), size)
                        : loader.LoadASCIIFromString(&document.model, &error, &warning, json.data(), size, "");
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!loaded) return fail(!access.missing.empty() ? access.missing : "it cannot be loaded: " + first_line(error));
    for (std::size_t n = 0; n < document.model.buffers.size(); ++n) {
        // tinygltf warns of a missing file and goes on.
        if (document.model.buffers[n].data.empty()) {
            return fail(fmt::format("buffer {} has no bytes{}", n, access.missing.empty() ? "" : ": " + access.missing));
        }
    }
    return document;
}

}  // namespace drtv::map
