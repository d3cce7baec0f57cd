#include "map_files/local_map.h"

#include "map_files/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

namespace drtv::map_files {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;
template <class Value>
using Found = tl::expected<Value, std::string>;

// Adds the documents that stand in a folder, which the command line calls `argument`.
Found<void> add_folder(const fs::path& folder, const std::string& argument, Paths& documents) {
    const std::size_t count_before = documents.size();
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        std::error_code ignored;  // of a link that leads nowhere
        if (is_document_name(entry->path().filename().string()) && entry->is_regular_file(ignored))
            documents.push_back(entry->path());
    }
    if (code)
        return tl::unexpected(fmt::format("cannot read the folder {}: {}", argument, code.message()));
    if (documents.size() == count_before)
        return tl::unexpected(fmt::format("the folder {} holds no .glb or .gltf file", argument));
    return {};
}

Found<void> add_argument(const std::string& argument, Paths& documents) {
    std::error_code code;
    const fs::file_status status = fs::status(argument, code);
    if (status.type() == fs::file_type::not_found)
        return tl::unexpected(fmt::format("the map {} does not exist", argument));
    if (code)
        return tl::unexpected(fmt::format("cannot read the map {}: {}", argument, code.message()));
    if (fs::is_directory(status))
        return add_folder(fs::canonical(argument, code), argument, documents);
    // A pipe or a device would never end.
    if (!fs::is_regular_file(status))
        return tl::unexpected(fmt::format("the map {} is not a regular file", argument));
    // A link keeps its own name.
    const fs::path absolute = fs::absolute(argument, code);
    const fs::path folder = fs::canonical(absolute.parent_path(), code);
    documents.push_back(folder / absolute.filename());
    return {};
}

bool lies_outside(const fs::path& folder, const fs::path& other) {
    const fs::path relative = folder.lexically_relative(other);
    return !relative.empty() && *relative.begin() == "..";
}

fs::path common_folder(const Paths& documents) {
    fs::path common = documents.front().parent_path();
    for (const fs::path& document : documents) {
        while (lies_outside(document.parent_path(), common))
            common = common.parent_path();
    }
    return common;
}

}  // namespace

Found<LocalMap> LocalMap::find(std::span<const std::string> arguments) {
    Paths named;
    for (const std::string& argument : arguments) {
        if (auto added = add_argument(argument, named); !added)
            return tl::unexpected(added.error());
    }
    LocalMap map;
    Paths documents;
    std::map<fs::path, fs::path> by_target;
    std::error_code code;
    std::ranges::sort(named);
    for (const fs::path& document : named) {
        if (by_target.emplace(fs::canonical(document, code), document).second)
            documents.push_back(document);
        else
            map.repeated_.push_back(document.string());
    }
    const fs::path folder = common_folder(documents);
    map.places_.push_back({"", folder});
    for (const auto& [target, document] : by_target) {
        const fs::path in_map = document.lexically_relative(folder);
        if (target.parent_path() != document.parent_path())
            map.places_.push_back({in_map.parent_path(), target.parent_path()});
    }
    for (const fs::path& document : documents) {
        std::string path = document.lexically_relative(folder).generic_string();
        if (auto checked = check_path(path); !checked)
            return tl::unexpected(fmt::format("the map {}: {}", document.string(), checked.error()));
        map.documents_.push_back(std::move(path));
    }
    std::ranges::sort(map.documents_);
    return map;
}

std::optional<fs::path> LocalMap::on_disk(const std::string& path) const {
    std::error_code code;
    for (const Place& place : places_) {
        const fs::path relative =
            place.at.empty() ? fs::path(path) : fs::path(path).lexically_relative(place.at);
        fs::path candidate = (place.folder / relative).lexically_normal();
        if (fs::is_regular_file(candidate, code))
            return candidate;
    }
    return std::nullopt;
}

}  // namespace drtv::map_files
