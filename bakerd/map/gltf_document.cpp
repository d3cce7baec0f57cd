#include "bakerd/map/gltf_document.h"

#include "bakerd/map/document_check.h"
#include "bakerd/map/document_uri.h"

#include <fmt/format.h>

#include <charconv>
#include <exception>
#include <optional>
#include <span>
#include <string_view>

namespace drtv::map {
namespace {

std::uint32_t load_u32(const FileBytes& bytes, std::size_t at) {
    return bytes[at] | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16 |
           std::uint32_t{bytes[at + 3]} << 24;
}

struct GlbChunks {
    std::string_view json;
    std::optional<std::span<const std::uint8_t>> binary;
};

// The chunks of a GLB, with its framing checked (glTF 2.0, section 4). Chunks of unknown types are passed
// over.
tl::expected<GlbChunks, std::string> glb_chunks(const FileBytes& bytes) {
    if (bytes.size() < 20)
        return tl::unexpected(fmt::format("a GLB file has at least 20 bytes, it has {}", bytes.size()));
    if (load_u32(bytes, 4) != 2)
        return tl::unexpected(fmt::format("it is GLB version {}, only 2 is supported", load_u32(bytes, 4)));
    // What follows the length in the header is not part of the GLB.
    const std::size_t length = load_u32(bytes, 8);
    if (length < 20 || length > bytes.size())
        return tl::unexpected(fmt::format("its GLB header says {} bytes, it has {}", length, bytes.size()));
    constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
    if (load_u32(bytes, 16) != json_chunk)
        return tl::unexpected(std::string("its first GLB chunk is not JSON"));
    GlbChunks chunks;
    for (std::size_t at = 12; at < length;) {
        if (length - at < 8)
            return tl::unexpected(fmt::format("the GLB chunk header at byte {} is cut off", at));
        const std::uint32_t size = load_u32(bytes, at), type = load_u32(bytes, at + 4);
        if (size > length - at - 8)
            return tl::unexpected(fmt::format("the GLB chunk at byte {} ends at {}, the GLB has {} bytes",
                                              at,
                                              at + 8 + std::uint64_t{size},
                                              length));
        if (at > 12 && (type == json_chunk || (type == binary_chunk && chunks.binary)))
            return tl::unexpected(fmt::format("the GLB chunk at byte {} stands twice", at));
        const std::span chunk = std::span(bytes).subspan(at + 8, size);
        if (type == json_chunk)
            chunks.json = {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
        if (type == binary_chunk)
            chunks.binary = chunk;
        at += 8 + std::size_t{size};
    }
    return chunks;
}

// What tinygltf's callbacks read from.
struct FileAccess {
    const FileSource& files;
    std::string folder;  // with a slash at its end, or empty
    const std::vector<OutsideBytes>& outside;
    std::optional<std::span<const std::uint8_t>> binary_chunk;
    std::string missing;  // the first sentence on a buffer that could not be read
};

tl::expected<FileBytes, std::string> read_outside(const FileAccess& access, const OutsideBytes& wanted) {
    const auto fail = [&](const std::string& why) {
        return tl::unexpected(fmt::format("{}: {}", wanted.element, why));
    };
    FileBytes bytes;
    if (wanted.path) {
        auto read = access.files(access.folder + *wanted.path);
        if (!read)
            return fail(read.error());
        bytes = std::move(*read);
    } else {
        if (!access.binary_chunk)
            return fail("it has no uri, and the file no binary chunk");
        bytes.assign(access.binary_chunk->begin(), access.binary_chunk->end());
    }
    const std::string source = wanted.path ? "'" + *wanted.path + "'" : "the binary chunk";
    if (bytes.size() > max_file_bytes)
        return fail(
            fmt::format("{} has {} bytes, over the limit of {}", source, bytes.size(), max_file_bytes));
    if (wanted.size_bytes) {
        if (bytes.size() < *wanted.size_bytes)
            return fail(
                fmt::format("{} has {} bytes, byteLength says {}", source, bytes.size(), *wanted.size_bytes));
        bytes.resize(*wanted.size_bytes);  // it may be longer
    }
    return bytes;
}

bool file_exists(const std::string&, void*) {
    return true;
}
std::string keep_path(const std::string& path, void*) {
    return path;
}
bool refuse_write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

bool read_whole(std::vector<unsigned char>* out, std::string*, const std::string& path, void* user) {
    auto& access = *static_cast<FileAccess*>(user);
    // Uris are places in `outside`; tinygltf may put "./" before one.
    const std::string_view digits = std::string_view(path).substr(path.starts_with("./") ? 2 : 0);
    std::size_t place = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), place);
    if (error != std::errc() || end != digits.data() + digits.size() || place >= access.outside.size())
        return false;
    auto bytes = read_outside(access, access.outside[place]);
    if (!bytes) {
        // An image may be missing as long as no material wants it.
        if (access.outside[place].size_bytes && access.missing.empty())
            access.missing = bytes.error();
        return false;
    }
    *out = std::move(*bytes);
    return true;
}

bool keep_encoded_image(tinygltf::Image* image,
                        const int,
                        std::string*,
                        std::string*,
                        int,
                        int,
                        const unsigned char* bytes,
                        int size,
                        void*) {
    image->image.assign(bytes, bytes + size);
    return true;
}

std::string first_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' '))
        text.pop_back();
    for (char& c : text) {
        if (c == '\n')
            c = ' ';
    }
    return text.substr(0, 300);
}

}  // namespace

tl::expected<GltfDocument, std::string> load_document(const std::string& path, const FileSource& files) {
    GltfDocument document;
    document.path = path;
    const auto fail = [&](const std::string& rest) { return tl::unexpected(document.at(rest)); };
    if (const auto problem = path_problem(path))
        return fail(*problem);
    const auto bytes = files(path);
    if (!bytes)
        return tl::unexpected(bytes.error());
    if (bytes->size() > max_file_bytes)
        return fail(fmt::format("it has {} bytes, over the limit of {}", bytes->size(), max_file_bytes));

    GlbChunks chunks{{reinterpret_cast<const char*>(bytes->data()), bytes->size()}, std::nullopt};
    if (chunks.json.starts_with("glTF")) {
        const auto found = glb_chunks(*bytes);
        if (!found)
            return fail(found.error());
        chunks = *found;
    }
    const std::size_t first = chunks.json.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || chunks.json[first] != '{')
        return fail("it is not a glTF file: it begins neither with JSON nor with a GLB header");
    const auto checked = check_document(chunks.json);
    if (!checked)
        return fail(checked.error());
    if (checked->json.size() > max_file_bytes)
        return fail("its JSON is too long");

    FileAccess access{files,
                      path.find('/') == std::string::npos ? "" : path.substr(0, path.rfind('/') + 1),
                      checked->outside,
                      chunks.binary,
                      ""};
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded_image, nullptr);
    loader.SetFsCallbacks({file_exists, keep_path, read_whole, refuse_write, &access});
    std::string error, warning;
    bool loaded = false;
    try {
        loaded = loader.LoadASCIIFromString(&document.model,
                                            &error,
                                            &warning,
                                            checked->json.data(),
                                            static_cast<unsigned>(checked->json.size()),
                                            "");
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!loaded)
        return fail(!access.missing.empty() ? access.missing : "it cannot be loaded: " + first_line(error));
    return document;
}

}  // namespace drtv::map
