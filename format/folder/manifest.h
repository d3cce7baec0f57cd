// sectors.json: what a folder of sector files holds, and of which bake it is (format/sectors.schema.json). It
// says of itself when a pull has begun; that all is there it says last.
#pragma once

#include "cli/failure.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drtv::folder {

using SectorPlace = std::pair<std::int32_t, std::int32_t>;  // j, i: the order in which sectors are listed

struct ListedFile {
    std::string sha256;
    std::int64_t size_bytes = 0;
    std::string map;  // FolderManifest::map, or that of an earlier pull of which the file was left

    bool operator==(const ListedFile&) const = default;
};

struct FolderManifest {
    std::string map;                     // digest of the content, 64 hexadecimal digits
    std::vector<std::string> documents;  // names of its glTF files
    std::string likeness;                // by which versions of a map know each other (MapSurvey, map.proto)
    std::string job;                     // its number on the server
    std::string preset;
    std::map<std::string, double> settings;  // all of them
    std::optional<std::array<double, 4>> region;
    std::uint32_t baker_version = 0;
    std::string format_version;   // "1.3"
    std::string server_version;   // "0.1.0"
    std::int64_t unfinished = 0;  // sectors of the job that had no file
    bool pulling = false;         // a pull has begun, and not come to its end
    std::map<SectorPlace, ListedFile> files;
};

// "sector_3_-2.drtv"
[[nodiscard]] std::string sector_file_name(std::int32_t i, std::int32_t j);

[[nodiscard]] std::string sector_file_path(const std::string& folder, const SectorPlace& place);

[[nodiscard]] std::string manifest_path(const std::string& folder);

// Nothing where the folder has none. Fails for one that cannot be read, or is none.
[[nodiscard]] cli::Result<std::optional<FolderManifest>> read_manifest(const std::string& folder);

// Warns where the manifest says that a pull is under way, or was cut off.
void warn_of_pull(const std::string& folder, const FolderManifest& manifest);
// Of the folder's own. Another fault of it is left to `drtv validate`.
void warn_of_pull(const std::string& folder);

// Whether both are of versions of one map: they name a document of the same name, or share objects.
[[nodiscard]] bool are_of_one_map(const FolderManifest& one, const FolderManifest& other);

[[nodiscard]] std::string manifest_text(const FolderManifest& manifest);

// What is looked at of a file.
enum class FileCheck : std::uint8_t { size, bytes };

// Empty where the file is as it is listed; else the end of a sentence that begins with it.
[[nodiscard]] std::string difference_from_list(const std::string& path,
                                               const ListedFile& listed,
                                               FileCheck check = FileCheck::bytes);

// Names of sector files in the folder that the manifest does not list, sorted.
[[nodiscard]] std::vector<std::string> unlisted_files(const std::string& folder,
                                                      const FolderManifest& manifest);

// What of the listed files is not as the manifest says: one sentence each, and of files beside them that it
// does not list.
[[nodiscard]] std::vector<std::string> check_listed_files(const std::string& folder,
                                                          const FolderManifest& manifest,
                                                          FileCheck check = FileCheck::bytes);

}  // namespace drtv::folder
