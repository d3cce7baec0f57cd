#include "bakerd/store/manifest.h"

#include "map_files/reference.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_map>

namespace drtv::store {
namespace {

constexpr std::size_t max_path_bytes = 1024;

bool valid_path(const std::string& path) {
    return path.size() <= max_path_bytes && map_files::check_path(path);
}

}  // namespace

Result<Manifest> normalised(Manifest manifest) {
    std::sort(manifest.files.begin(), manifest.files.end(), [](const ManifestFile& a, const ManifestFile& b) {
        return a.path < b.path;
    });
    std::sort(manifest.roots.begin(), manifest.roots.end());
    for (std::size_t n = 0; n < manifest.files.size(); ++n) {
        const std::string& path = manifest.files[n].path;
        if (!valid_path(path))
            return fail(ErrorCode::invalid_argument,
                        fmt::format("the file path '{}' is not a plain relative path", path.substr(0, 100)));
        if (n > 0 && manifest.files[n - 1].path == path)
            return fail(ErrorCode::invalid_argument,
                        fmt::format("the file '{}' stands twice in the map", path));
    }
    if (manifest.roots.empty())
        return fail(ErrorCode::invalid_argument, "the map names no glTF file to import");
    const auto twice = std::adjacent_find(manifest.roots.begin(), manifest.roots.end());
    if (twice != manifest.roots.end())
        return fail(ErrorCode::invalid_argument,
                    fmt::format("the root '{}' stands twice in the map", *twice));
    for (const std::string& root : manifest.roots) {
        const bool known = std::any_of(manifest.files.begin(),
                                       manifest.files.end(),
                                       [&](const ManifestFile& file) { return file.path == root; });
        if (!known)
            return fail(ErrorCode::invalid_argument,
                        fmt::format("the root '{}' is not among the map's files", root));
    }
    return manifest;
}

std::string encode_manifest(const Manifest& manifest) {
    nlohmann::json json = {{"roots", manifest.roots}, {"files", nlohmann::json::array()}};
    for (const ManifestFile& file : manifest.files)
        json["files"].push_back(
            {{"path", file.path}, {"sha256", to_hex(file.digest)}, {"size", file.size_bytes}});
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<Manifest> decode_manifest(std::string_view bytes) {
    const nlohmann::json json = nlohmann::json::parse(bytes, nullptr, false);
    Manifest manifest;
    try {
        manifest.roots = json.at("roots").get<std::vector<std::string>>();
        for (const auto& file : json.at("files")) {
            const auto digest = map::digest_from_hex(file.at("sha256").get<std::string>());
            if (!digest)
                return fail(ErrorCode::data_loss, "a stored map has a malformed digest");
            manifest.files.push_back(
                {file.at("path").get<std::string>(), *digest, file.at("size").get<std::int64_t>()});
        }
    } catch (const nlohmann::json::exception& exception) {
        return fail(ErrorCode::data_loss, fmt::format("a stored map cannot be read: {}", exception.what()));
    }
    return manifest;
}

map::FileSource manifest_source(const Manifest& manifest, BlobStore& store) {
    std::unordered_map<std::string, Digest> digests;
    for (const ManifestFile& file : manifest.files)
        digests.emplace(file.path, file.digest);
    return [digests = std::move(digests),
            &store](const std::string& path) -> tl::expected<map::FileBytes, map::FileFailure> {
        const auto found = digests.find(path);
        if (found == digests.end())
            return tl::unexpected(map::FileFailure{fmt::format("the file '{}' is missing", path), true});
        auto bytes = store.get(found->second);
        if (!bytes)
            return tl::unexpected(
                map::FileFailure{fmt::format("the file '{}' is lost: {}", path, bytes.error().message)});
        return std::move(*bytes);
    };
}

}  // namespace drtv::store
