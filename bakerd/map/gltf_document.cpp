#include "bakerd/map/gltf_document.h"

#include "bakerd/map/data_uri.h"
#include "bakerd/map/document_check.h"
#include "bakerd/map/file_kind.h"
#include "bakerd/map/glb.h"
#include "map_files/reference.h"

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
    const std::vector<OutsideBytes>& outside;
    std::optional<std::span<const std::uint8_t>> binary_chunk;
    std::string missing;  // the first sentence on a buffer that could not be read
};

struct NamedBytes {
    std::string source;  // for messages
    FileBytes bytes;
};

tl::expected<NamedBytes, std::string> read_file_of(const FileSource& files,
                                                   const std::vector<std::string>& paths) {
    std::string first_sentence;
    for (const std::string& path : paths) {
        auto bytes = files(path);
        if (bytes)
            return NamedBytes{"'" + path + "'", std::move(*bytes)};
        if (first_sentence.empty())
            first_sentence = bytes.error().sentence;
        if (!bytes.error().is_missing)
            return tl::unexpected(bytes.error().sentence);
    }
    return tl::unexpected(first_sentence);
}

tl::expected<NamedBytes, std::string> read_source(const FileAccess& access, const OutsideBytes& wanted) {
    if (!wanted.files.empty())
        return read_file_of(access.files, wanted.files);
    if (!access.binary_chunk)
        return tl::unexpected(std::string("it has no uri, and the file no binary chunk"));
    return NamedBytes{"the binary chunk", {access.binary_chunk->begin(), access.binary_chunk->end()}};
}

tl::expected<FileBytes, std::string> read_outside(const FileAccess& access, const OutsideBytes& wanted) {
    const auto fail = [&](const std::string& why) {
        return tl::unexpected(fmt::format("{}: {}", wanted.element, why));
    };
    auto read = read_source(access, wanted);
    if (!read)
        return fail(read.error());
    auto& [source, bytes] = *read;
    const std::size_t size = bytes.size();
    if (size > max_file_bytes)
        return fail(fmt::format("{} has {} bytes, over the limit of {}", source, size, max_file_bytes));
    if (!wanted.size_bytes)
        return std::move(bytes);
    if (size < *wanted.size_bytes)
        return fail(fmt::format("{} has {} bytes, byteLength says {}", source, size, *wanted.size_bytes));
    bytes.resize(*wanted.size_bytes);  // it may be longer
    return std::move(bytes);
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
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (const std::string_view kind = foreign_kind(text); !kind.empty())
        return tl::unexpected(fmt::format("it is {}", kind));
    // A reader may ignore it (RFC 8259, 8.1).
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark))
        text.remove_prefix(byte_order_mark.size());
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
    if (const auto checked = map_files::check_path(path); !checked)
        return fail(checked.error());
    const auto bytes = files(path);
    if (!bytes)
        return tl::unexpected(bytes.error().sentence);
    if (bytes->size() > max_file_bytes)
        return fail(fmt::format("it has {} bytes, over the limit of {}", bytes->size(), max_file_bytes));
    const auto chunks = chunks_of(*bytes);
    if (!chunks)
        return fail(chunks.error());
    const auto checked = check_document(chunks->json, path);
    if (!checked)
        return fail(checked.error());
    if (checked->json.size() > max_file_bytes)
        return fail("its JSON is too long");
    FileAccess access{files, checked->outside, chunks->binary, ""};
    auto model = load_model(checked->json, access);
    if (!model)
        return fail(model.error());
    document.model = std::move(*model);
    return document;
}

}  // namespace drtv::map
