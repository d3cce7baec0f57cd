// Sector files of a job, on their way into a folder that is whole in the end.
#pragma once

#include "client/connection.h"
#include "client/file_writers.h"
#include "client/folder_lock.h"
#include "format/cli/failure.h"
#include "format/folder/manifest.h"

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace drtv::client {

// Pulls the finished files of a job into a folder, as often as asked, and then writes its manifest. A file
// that is there already and right is left alone. REQUIRES: the folder is there; the connection outlives it.
class FolderPull {
  public:
    // `map` is the job's. Fails for a folder of another map (earlier_manifest).
    [[nodiscard]] static cli::Result<FolderPull> open(
        ServerConnection& connection, v1::Job job, v1::Map map, std::string folder, bool replace);

    // The files of sectors that have been finished since.
    [[nodiscard]] cli::Result<void> pull_new();

    // All of the job's files, looked at once more; removes files of earlier pulls that the map no longer has;
    // then writes the manifest. One pull at a time is here in a folder.
    [[nodiscard]] cli::Result<void> finish();

    // What was done, on standard output.
    void report() const;

  private:
    FolderPull(ServerConnection& connection, v1::Job job, v1::Map map, std::string folder, bool replace)
        : connection_(connection),
          job_(std::move(job)),
          map_(std::move(map)),
          folder_(std::move(folder)),
          replace_(replace) {}

    [[nodiscard]] cli::Result<void> read_earlier();
    // As long as it takes a daemon that restarts.
    [[nodiscard]] cli::Result<void> pull();
    void look_at_folder();
    // Whether nobody has removed one of the job's files.
    [[nodiscard]] bool all_are_there();
    // Sectors that are done, of which the folder has no right file.
    [[nodiscard]] cli::Result<std::vector<v1::SectorCoordinate>> missing_files();
    [[nodiscard]] cli::Result<void> stream(std::span<const v1::SectorCoordinate> missing,
                                           FileWriters& writers);
    // Whether the sector is done, and the folder has no right file of it.
    [[nodiscard]] bool is_missing(const v1::Sector& sector);
    [[nodiscard]] bool has_file(const folder::SectorPlace& place, const folder::ListedFile& listed) const;
    // From here to the end the folder's manifest says that it is not whole, and what was there.
    [[nodiscard]] cli::Result<void> begin();
    [[nodiscard]] cli::Result<void> write_begun();
    [[nodiscard]] cli::Result<void> complete();

    ServerConnection& connection_;
    v1::Job job_;
    v1::Map map_;
    const std::string folder_;
    const bool replace_;
    bool has_begun_ = false;
    std::optional<FolderLock> lock_;  // while it comes to its end
    std::optional<folder::FolderManifest> earlier_;
    folder::FolderManifest manifest_;
    std::unordered_set<std::string> names_there_;  // in the folder
    std::set<folder::SectorPlace> here_;           // sectors of the job whose files are right
    std::set<folder::SectorPlace> pulled_;         // those that this pull wrote
    std::int64_t removed_ = 0;
};

}  // namespace drtv::client
