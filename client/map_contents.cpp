#include "client/map_contents.h"

#include "client/gltf_references.h"
#include "format/folder/sha256.h"
#include "map_files/limits.h"
#include "map_files/local_map.h"
#include "map_files/reference.h"

#include <filesystem>
#include <set>
#include <system_error>

namespace drtv::client {
namespace {

// The document, the files that it names, and those that name roles for it.
void insert_files(const map_files::LocalMap& map, const std::string& document, std::set<std::string>& paths) {
    paths.insert(document);
    if (const std::string roles = map_files::roles_path(document); map.on_disk(roles))
        paths.insert(roles);
    for (const std::string& uri : outside_uris(map.on_disk(document).value_or(""))) {
        const auto files = map_files::files_named(document, uri);
        if (!files)
            continue;
        for (const std::string& path : *files) {
            if (!map.on_disk(path))
                continue;
            paths.insert(path);
            break;
        }
    }
}

cli::Result<MapContentFile> content_file(const map_files::LocalMap& map, const std::string& path) {
    const std::filesystem::path place = map.on_disk(path).value_or(path);
    std::error_code code;
    const auto size_bytes = static_cast<std::int64_t>(std::filesystem::file_size(place, code));
    if (auto checked = map_files::check_size(place.string(), code ? 0 : size_bytes); !checked)
        return cli::fail(cli::exit_invalid, checked.error());
    const auto digest = folder::sha256_of_file(place.string());
    if (!digest)
        return tl::unexpected(digest.error());
    MapContentFile file;
    file.disk_path = place.string();
    file.map_path = path;
    file.sha256 = *digest;
    file.size_bytes = size_bytes;
    return file;
}

}  // namespace

cli::Result<MapContents> collect_map(const std::vector<std::string>& arguments) {
    const auto local = map_files::LocalMap::find(arguments);
    if (!local)
        return cli::fail(cli::exit_unreadable, local.error());
    MapContents contents{{}, local->documents(), local->repeated()};
    std::set<std::string> paths;
    for (const std::string& document : local->documents())
        insert_files(*local, document, paths);
    const auto document_count = static_cast<std::int64_t>(local->documents().size());
    if (auto checked = map_files::check_counts(document_count, static_cast<std::int64_t>(paths.size()));
        !checked)
        return cli::fail(cli::exit_invalid, checked.error());
    for (const std::string& path : paths) {
        auto file = content_file(*local, path);
        if (!file)
            return tl::unexpected(file.error());
        contents.files.push_back(std::move(*file));
    }
    return contents;
}

}  // namespace drtv::client
