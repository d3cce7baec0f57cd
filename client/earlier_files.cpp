#include "client/earlier_files.h"

#include "client/number_text.h"
#include "format/cli/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

namespace drtv::client {

namespace fs = std::filesystem;

std::int64_t settle_earlier_files(const std::string& folder,
                                  const folder::FolderManifest& earlier,
                                  bool stay,
                                  folder::FolderManifest& manifest) {
    std::int64_t removed = 0;
    std::int64_t changed = 0;
    std::int64_t left = 0;
    for (const auto& [place, file] : earlier.files) {
        if (manifest.files.contains(place))
            continue;
        const std::string path = folder::sector_file_path(folder, place);
        std::error_code code;
        if (!folder::difference_from_list(path, file).empty()) {
            changed += fs::exists(path, code) ? 1 : 0;
            continue;
        }
        if (stay) {
            manifest.files[place] = file;
            ++left;
        } else {
            removed += fs::remove(path, code) ? 1 : 0;
        }
    }
    if (left > 0 && earlier.settings != manifest.settings)
        cli::warn(fmt::format("{} in {} stay, and were baked with other settings",
                              counted(left, "file of an earlier pull", "files of earlier pulls"),
                              folder));
    if (changed > 0)
        cli::warn(
            fmt::format("{} sector files in {} are no longer part of the map, and stay: somebody changed "
                        "them since they were pulled",
                        changed,
                        folder));
    return removed;
}

void warn_of_strangers(const std::string& folder, const folder::FolderManifest& manifest) {
    const std::vector<std::string> strangers = folder::unlisted_files(folder, manifest);
    if (strangers.empty())
        return;
    const auto count = static_cast<std::int64_t>(strangers.size());
    cli::warn(fmt::format("{} in {} of no pull, the first {}: drtv validate refuses the folder with them",
                          counted(count, "sector file is", "sector files are"),
                          folder,
                          strangers.front()));
}

}  // namespace drtv::client
