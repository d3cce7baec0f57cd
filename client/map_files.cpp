#include "client/map_files.h"

#include "client/gltf_references.h"
#include "client/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

// Adds the glTF files that stand in a folder, which the command line calls `argument`.
cli::Result<void> add_folder(const fs::path& folder, const std::string& argument, Paths& roots) {
    const std::size_t count_before = roots.size();
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(folder, code)) {
        const fs::path extension = entry.path().extension();
        const bool is_gltf = extension == ".glb" || extension == ".gltf";
        if (is_gltf && fs::is_regular_file(entry.path(), code))
            roots.push_back(entry.path());
    }
    if (code)
        return cli::fail(cli::exit_unreadable,
                         fmt::format("cannot read the folder {}: {}", argument, code.message()));
    if (roots.size() == count_before)
        return cli::fail(cli::exit_unreadable,
                         fmt::format("the folder {} holds no .glb or .gltf file", argument));
    return {};
}

cli::Result<void> add_argument(const std::string& argument, Paths& roots) {
    std::error_code code;
    const fs::path path = fs::weakly_canonical(fs::absolute(argument, code), code);
    if (!fs::exists(path, code))
        return cli::fail(cli::exit_unreadable, fmt::format("the map {} does not exist", argument));
    if (fs::is_directory(path, code))
        return add_folder(path, argument, roots);
    // A pipe or a device would never end.
    if (!fs::is_regular_file(path, code))
        return cli::fail(cli::exit_unreadable, fmt::format("the map {} is not a regular file", argument));
    roots.push_back(path);
    return {};
}

cli::Result<Paths> find_roots(const std::vector<std::string>& arguments) {
    Paths roots;
    for (const std::string& argument : arguments) {
        if (auto added = add_argument(argument, roots); !added)
            return tl::unexpected(added.error());
    }
    std::sort(roots.begin(), roots.end());
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    return roots;
}

bool lies_outside(const fs::path& folder, const fs::path& other) {
    const fs::path relative = folder.lexically_relative(other);
    return !relative.empty() && *relative.begin() == "..";
}

fs::path common_folder(const Paths& roots) {
    fs::path common = roots.front().parent_path();
    for (const fs::path& root : roots) {
        while (lies_outside(root.parent_path(), common))
            common = common.parent_path();
    }
    return common;
}

// The root and the files beside it that it names.
void insert_files(const fs::path& root, std::set<fs::path>& paths) {
    paths.insert(root);
    for (const std::string& reference : referenced_files(root.string())) {
        std::error_code code;
        const fs::path path = (root.parent_path() / reference).lexically_normal();
        if (fs::is_regular_file(path, code))
            paths.insert(path);
    }
}

cli::Result<LocalFile> local_file(const fs::path& path, const fs::path& folder) {
    const auto digest = sha256_of_file(path.string());
    if (!digest)
        return tl::unexpected(digest.error());
    LocalFile file;
    file.disk_path = path.string();
    file.map_path = path.lexically_relative(folder).generic_string();
    file.sha256 = *digest;
    std::error_code code;
    file.size_bytes = static_cast<std::int64_t>(fs::file_size(path, code));
    return file;
}

}  // namespace

cli::Result<LocalMap> collect_map(const std::vector<std::string>& arguments) {
    const auto roots = find_roots(arguments);
    if (!roots)
        return tl::unexpected(roots.error());
    const fs::path folder = common_folder(*roots);
    LocalMap map;
    std::set<fs::path> paths;
    for (const fs::path& root : *roots) {
        map.roots.push_back(root.lexically_relative(folder).generic_string());
        insert_files(root, paths);
    }
    for (const fs::path& path : paths) {
        auto file = local_file(path, folder);
        if (!file)
            return tl::unexpected(file.error());
        map.files.push_back(std::move(*file));
    }
    return map;
}

}  // namespace drtv::client
