#include "client/folder_manifest.h"

#include "client/job_text.h"
#include "settings/message/job_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <vector>

namespace drtv::client {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_of(const v1::Map& map) {
    std::vector<std::string> names;
    for (const std::string& root : map.roots())
        names.push_back(fs::path(root).filename().string());
    return names;
}

// What the map says of itself.
folder::FolderManifest manifest_of(const v1::Map& map) {
    folder::FolderManifest manifest;
    manifest.map = map.content_sha256();
    manifest.documents = names_of(map);
    manifest.likeness = map.survey().likeness();
    return manifest;
}

}  // namespace

folder::FolderManifest manifest_of(const v1::Map& map, const v1::Job& job, const v1::ServerInfo& server) {
    folder::FolderManifest manifest = manifest_of(map);
    manifest.job = job_number(job);
    manifest.preset = job.settings().preset();
    if (const auto settings = settings::read_settings(job)) {
        for (const settings::Setting& setting : settings::table())
            manifest.settings[std::string(setting.name)] = settings::value_of(*settings, setting);
    }
    if (job.has_region())
        manifest.region = {job.region().x0(), job.region().y0(), job.region().x1(), job.region().y1()};
    manifest.baker_version = server.baker_version();
    manifest.format_version = server.format_version();
    manifest.server_version = server.version();
    return manifest;
}

cli::Result<std::optional<folder::FolderManifest>> earlier_manifest(const std::string& folder,
                                                                    const v1::Map& map,
                                                                    bool replace) {
    auto earlier = folder::read_manifest(folder);
    if (replace || !earlier || !*earlier || folder::are_of_one_map(**earlier, manifest_of(map)))
        return earlier;
    return cli::fail(
        cli::exit_invalid,
        fmt::format("the folder {} holds sectors of another map ({}): pull to a folder of its own, or "
                    "say --replace",
                    folder,
                    fmt::join((*earlier)->documents, ", ")));
}

}  // namespace drtv::client
