#include "manifest.h"

#include "cli/report.h"
#include "sha256.h"
#include "whole_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

namespace drtv::folder {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int schema_version = 1;

Json json_of(const SectorPlace& place, const ListedFile& file, const FolderManifest& manifest) {
    const auto [j, i] = place;
    Json json;
    json["sector"] = {i, j};
    json["file"] = sector_file_name(i, j);
    json["sha256"] = file.sha256;
    json["size"] = file.size_bytes;
    if (file.map != manifest.map)
        json["map"] = file.map;
    return json;
}

// Throws what Json throws.
FolderManifest read_json(const Json& json) {
    FolderManifest manifest;
    manifest.map = json.at("map").get<std::string>();
    manifest.documents = json.at("documents").get<std::vector<std::string>>();
    manifest.likeness = json.at("likeness").get<std::string>();
    manifest.job = json.at("job").get<std::string>();
    manifest.preset = json.at("preset").get<std::string>();
    manifest.settings = json.at("settings").get<std::map<std::string, double>>();
    if (json.contains("region"))
        manifest.region = json.at("region").get<std::array<double, 4>>();
    manifest.baker_version = json.at("baker_version").get<std::uint32_t>();
    manifest.format_version = json.at("format_version").get<std::string>();
    manifest.server_version = json.at("server_version").get<std::string>();
    manifest.unfinished = json.at("unfinished").get<std::int64_t>();
    manifest.pulling = json.value("pulling", false);
    for (const Json& entry : json.at("sectors")) {
        const auto sector = entry.at("sector").get<std::array<std::int32_t, 2>>();
        ListedFile file{entry.at("sha256").get<std::string>(), entry.at("size").get<std::int64_t>(), ""};
        file.map = entry.value("map", manifest.map);
        manifest.files[{sector[1], sector[0]}] = std::move(file);
    }
    return manifest;
}

}  // namespace

std::string sector_file_name(std::int32_t i, std::int32_t j) {
    return "sector_" + std::to_string(i) + "_" + std::to_string(j) + ".drtv";
}

std::string sector_file_path(const std::string& folder, const SectorPlace& place) {
    return folder + "/" + sector_file_name(place.second, place.first);
}

std::string manifest_path(const std::string& folder) {
    return folder + "/sectors.json";
}

cli::Result<std::optional<FolderManifest>> read_manifest(const std::string& folder) {
    const std::string path = manifest_path(folder);
    std::error_code code;
    if (!fs::exists(path, code))
        return std::nullopt;
    const auto text = read_whole(path);
    if (!text)
        return tl::unexpected(text.error());
    try {
        const Json json = Json::parse(*text);
        if (json.at("version").get<int>() > schema_version)
            return cli::fail(cli::exit_invalid,
                             path + " was written by a newer bake than this program knows");
        return read_json(json);
    } catch (const nlohmann::json::exception&) {
        return cli::fail(cli::exit_invalid,
                         path + " is not the manifest of a pull: remove it, and pull the job again");
    }
}

void warn_of_pull(const std::string& folder, const FolderManifest& manifest) {
    if (manifest.pulling)
        cli::warn("a pull into " + folder + " has begun, and not come to its end: files may be missing");
}

void warn_of_pull(const std::string& folder) {
    if (const auto manifest = read_manifest(folder); manifest && *manifest)
        warn_of_pull(folder, **manifest);
}

bool are_of_one_map(const FolderManifest& one, const FolderManifest& other) {
    const auto names_it = [&](const std::string& name) {
        return std::ranges::find(other.documents, name) != other.documents.end();
    };
    if (std::ranges::any_of(one.documents, names_it))
        return true;
    constexpr std::size_t digits = 16;
    for (std::size_t at = 0; at + digits <= one.likeness.size(); at += digits) {
        const std::size_t found = other.likeness.find(one.likeness.substr(at, digits));
        if (found != std::string::npos && found % digits == 0)
            return true;
    }
    return false;
}

std::string manifest_text(const FolderManifest& manifest) {
    Json json;
    json["kind"] = "sectors";
    json["version"] = schema_version;
    json["map"] = manifest.map;
    json["documents"] = manifest.documents;
    json["likeness"] = manifest.likeness;
    json["job"] = manifest.job;
    json["preset"] = manifest.preset;
    json["settings"] = manifest.settings;
    if (manifest.region)
        json["region"] = *manifest.region;
    json["baker_version"] = manifest.baker_version;
    json["format_version"] = manifest.format_version;
    json["server_version"] = manifest.server_version;
    json["unfinished"] = manifest.unfinished;
    if (manifest.pulling)
        json["pulling"] = true;
    // One line each, so that a version control shows which have changed.
    json["sectors"] = Json::array();
    std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace);
    std::string lines;
    for (const auto& [place, file] : manifest.files)
        lines += (lines.empty() ? "\n    " : ",\n    ") + json_of(place, file, manifest).dump();
    const std::string empty = "[]\n}";
    text.replace(
        text.size() - empty.size(), empty.size(), "[" + lines + (lines.empty() ? "" : "\n  ") + "]\n}\n");
    return text;
}

std::string difference_from_list(const std::string& path, const ListedFile& listed, FileCheck check) {
    std::error_code code;
    const std::uintmax_t size_bytes = fs::file_size(path, code);
    if (code)
        return "is listed, and cannot be read: " + code.message();
    if (std::cmp_not_equal(size_bytes, listed.size_bytes))
        return "has " + std::to_string(size_bytes) + " bytes, and is listed with " +
               std::to_string(listed.size_bytes);
    if (check == FileCheck::size)
        return "";
    const auto digest = sha256_of_file(path);
    if (!digest)
        return "is listed, and cannot be read";
    return *digest == listed.sha256 ? "" : "is not the file that is listed: its bytes differ";
}

std::vector<std::string> unlisted_files(const std::string& folder, const FolderManifest& manifest) {
    std::set<std::string> listed;
    for (const auto& [place, file] : manifest.files)
        listed.insert(sector_file_name(place.second, place.first));
    std::vector<std::string> unlisted;
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        if (entry->path().extension() == ".drtv" && !listed.contains(name))
            unlisted.push_back(name);
    }
    std::ranges::sort(unlisted);
    return unlisted;
}

std::vector<std::string> check_listed_files(const std::string& folder,
                                            const FolderManifest& manifest,
                                            FileCheck check) {
    std::vector<std::string> sentences;
    for (const auto& [place, listed] : manifest.files) {
        const std::string difference = difference_from_list(sector_file_path(folder, place), listed, check);
        if (!difference.empty())
            sentences.push_back(manifest_path(folder) + ": " + sector_file_name(place.second, place.first) +
                                " " + difference);
    }
    for (const std::string& name : unlisted_files(folder, manifest))
        sentences.push_back(manifest_path(folder) + ": " + name + " is not listed");
    return sentences;
}

}  // namespace drtv::folder
