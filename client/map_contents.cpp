#include "client/map_contents.h"

#include "client/gltf_references.h"
#include "format/cli/report.h"
#include "format/folder/sha256.h"
#include "map_files/limits.h"
#include "map_files/local_map.h"
#include "map_files/reference.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace drtv::client {
namespace {

using DiskPaths = std::map<std::string, std::filesystem::path>;  // by map path

bool insert_if_there(const map_files::LocalMap& map, const std::string& path, DiskPaths& paths) {
    if (paths.contains(path))
        return true;
    auto place = map.on_disk(path);
    if (place)
        paths.emplace(path, std::move(*place));
    return place.has_value();
}

// The document, the files that it names, and those that name roles for it.
void insert_files(const map_files::LocalMap& map, const std::string& document, DiskPaths& paths) {
    // One that was found and has gone since is told when it is read.
    if (!insert_if_there(map, document, paths))
        paths.emplace(document, document);
    insert_if_there(map, map_files::roles_path(document), paths);
    for (const std::string& uri : outside_uris(paths.at(document))) {
        const auto files = map_files::files_named(document, uri);
        for (const std::string& path : files.value_or(std::vector<std::string>())) {
            if (insert_if_there(map, path, paths))
                break;
        }
    }
}

cli::Result<MapContentFile> content_file(const std::string& path, const std::filesystem::path& place) {
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

// A file that was to be roles.json, as it seems.
void warn_of_roles_files(const map_files::LocalMap& local) {
    namespace fs = std::filesystem;
    std::set<fs::path> folders;
    for (const std::string& document : local.documents()) {
        if (const auto place = local.on_disk(document))
            folders.insert(place->parent_path());
    }
    for (const fs::path& folder : folders) {
        std::error_code code;
        for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
            std::string name = entry->path().filename().string();
            std::ranges::transform(
                name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
            const bool is_meant = name == "roles.json" || name == "role.json";
            if (is_meant && entry->path().filename() != "roles.json")
                cli::warn(entry->path().string() + " is not read: did you mean roles.json?");
        }
    }
}

}  // namespace

cli::Result<MapContents> collect_map(const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments) {
        std::error_code code;
        if (argument.find('=') != std::string::npos && !std::filesystem::exists(argument, code))
            return cli::fail(cli::exit_usage,
                             argument + " is no map: a setting needs a --set of its own, --set " + argument);
    }
    const auto local = map_files::LocalMap::find(arguments);
    if (!local)
        return cli::fail(cli::exit_unreadable, local.error());
    MapContents contents{{}, local->documents(), local->repeated()};
    warn_of_roles_files(*local);
    DiskPaths paths;
    for (const std::string& document : local->documents())
        insert_files(*local, document, paths);
    const auto document_count = static_cast<std::int64_t>(local->documents().size());
    if (auto checked = map_files::check_counts(document_count, static_cast<std::int64_t>(paths.size()));
        !checked)
        return cli::fail(cli::exit_invalid, checked.error());
    for (const auto& [path, place] : paths) {
        auto file = content_file(path, place);
        if (!file)
            return tl::unexpected(file.error());
        contents.files.push_back(std::move(*file));
    }
    return contents;
}

}  // namespace drtv::client
