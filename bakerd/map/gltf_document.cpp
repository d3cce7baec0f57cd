#include "bakerd/map/gltf_document.h"

#include "bakerd/map/document_check.h"
#include "bakerd/map/document_uri.h"
#include "bakerd/map/glb.h"

#include <fmt/format.h>

#include <charconv>
#include <exception>
#include <optional>
#include <span>
#include <string_view>

namespace drtv::map {
namespace {

// What tinygltf's callbacks read from.
struct FileAccess {
    const FileSource& files;
    std::string folder;  // with a slash at its end, or empty
    const std::vector<OutsideBytes>& outside;
    std::optional<std::span<const std::uint8_t>> binary_chunk;
    std::string missing;  // the first sentence on a buffer that could not be read
};

tl::expected<FileBytes, std::string> read_source(const FileAccess& access, const OutsideBytes& wanted) {
    if (wanted.path)
        return access.files(access.folder + *wanted.path);
    if (!access.binary_chunk)
        return tl::unexpected(std::string("it has no uri, and the file no binary chunk"));
    return FileBytes(access.binary_chunk->begin(), access.binary_chunk->end());
}

tl::expected<FileBytes, std::string> read_outside(const FileAccess& access, const OutsideBytes& wanted) {
    const auto fail = [&](const std::string& why) {
        return tl::unexpected(fmt::format("{}: {}", wanted.element, why));
    };
    auto bytes = read_source(access, wanted);
    if (!bytes)
        return fail(bytes.error());
    const std::string source = wanted.path ? "'" + *wanted.path + "'" : "the binary chunk";
    const std::size_t size = bytes->size();
    if (size > max_file_bytes)
        return fail(fmt::format("{} has {} bytes, over the limit of {}", source, size, max_file_bytes));
    if (!wanted.size_bytes)
        return bytes;
    if (size < *wanted.size_bytes)
        return fail(fmt::format("{} has {} bytes, byteLength says {}", source, size, *wanted.size_bytes));
    bytes->resize(*wanted.size_bytes);  // it may be longer
    return bytes;
}

// Uris are places in `outside`; tinygltf may put "./" before one.
const OutsideBytes* outside_named(const FileAccess& access, std::string_view path) {
    if (path.starts_with("./"))
        path.remove_prefix(2);
    const char* const path_end = path.data() + path.size();
    std::size_t place = 0;
    const auto [end, error] = std::from_chars(path.data(), path_end, place);
    const bool is_number = error == std::errc() && end == path_end;
    if (!is_number || place >= access.outside.size())
        return nullptr;
    return &access.outside[place];
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
    const OutsideBytes* wanted = outside_named(access, path);
    if (wanted == nullptr)
        return false;
    auto bytes = read_outside(access, *wanted);
    if (!bytes) {
        // An image may be missing as long as no material wants it.
        if (wanted->size_bytes && access.missing.empty())
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

// The JSON and the binary chunk of a file of either kind.
tl::expected<GlbChunks, std::string> chunks_of(const FileBytes& bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    GlbChunks chunks{text, std::nullopt};
    if (text.starts_with("glTF")) {
        const auto found = glb_chunks(bytes);
        if (!found)
            return found;
        chunks = *found;
    }
    const std::size_t first = chunks.json.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || chunks.json[first] != '{')
        return tl::unexpected(
            std::string("it is not a glTF file: it begins neither with JSON nor with a GLB header"));
    return chunks;
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

tl::expected<tinygltf::Model, std::string> load_model(const std::string& json, FileAccess& access) {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded_image, nullptr);
    loader.SetFsCallbacks({file_exists, keep_path, read_whole, refuse_write, &access});
    tinygltf::Model model;
    std::string error;
    std::string warning;
    bool loaded = false;
    try {
        const auto size = static_cast<unsigned>(json.size());
        loaded = loader.LoadASCIIFromString(&model, &error, &warning, json.data(), size, "");
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (loaded)
        return model;
    if (!access.missing.empty())
        return tl::unexpected(access.missing);
    return tl::unexpected("it cannot be loaded: " + first_line(error));
}

}  // namespace

tl::expected<GltfDocument, std::string> load_document(const std::string& path, const FileSource& files) {
    GltfDocument document;
    document.path = path;
    const auto fail = [&](const std::string& rest) { return tl::unexpected(document.at(rest)); };
    if (const auto checked = check_path(path); !checked)
        return fail(checked.error());
    const auto bytes = files(path);
    if (!bytes)
        return tl::unexpected(bytes.error());
    if (bytes->size() > max_file_bytes)
        return fail(fmt::format("it has {} bytes, over the limit of {}", bytes->size(), max_file_bytes));
    const auto chunks = chunks_of(*bytes);
    if (!chunks)
        return fail(chunks.error());
    const auto checked = check_document(chunks->json);
    if (!checked)
        return fail(checked.error());
    if (checked->json.size() > max_file_bytes)
        return fail("its JSON is too long");
    FileAccess access{files, folder_of(path), checked->outside, chunks->binary, ""};
    auto model = load_model(checked->json, access);
    if (!model)
        return fail(model.error());
    document.model = std::move(*model);
    return document;
}

}  // namespace drtv::map
