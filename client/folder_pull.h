// Sector files of a job, on their way into a folder.
#pragma once

#include "client/connection.h"
#include "format/cli/failure.h"

#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace drtv::client {

// Pulls the finished files of a job into a folder, as often as asked: each file once. A file that is there
// already and right is left alone. REQUIRES: the folder is there; the connection outlives it.
class FolderPull {
  public:
    FolderPull(ServerConnection& connection, const std::string& job, std::string folder);

    // Those that have been finished since.
    [[nodiscard]] cli::Result<void> pull();

    // What was done, on standard output.
    void report() const;

  private:
    [[nodiscard]] cli::Result<void> choose(v1::PullSectorsRequest& wanted);
    [[nodiscard]] bool has_file_of(const v1::Sector& sector) const;

    ServerConnection& connection_;
    const std::string job_;
    const std::string folder_;
    std::set<std::pair<std::int32_t, std::int32_t>> here_;  // sectors whose files are in the folder
    std::int64_t pulled_ = 0;
    std::int64_t unchanged_ = 0;
    std::int64_t unfinished_ = 0;
};

}  // namespace drtv::client
