// Sector files of a job, on their way into a folder.
#pragma once

#include "client/connection.h"

#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace drtv::client {

// Pulls the finished files of a job into a folder, as often as asked: each file once. A file that is there
// already and right is left alone. REQUIRES: the folder is there; the connection outlives it.
class FolderPull {
  public:
    FolderPull(Connection& connection, const std::string& job, std::string folder);

    // Those that have been finished since.
    [[nodiscard]] tl::expected<void, std::string> pull();

    // What was done, on standard output.
    void report() const;

  private:
    [[nodiscard]] tl::expected<void, std::string> choose(v1::PullSectorsRequest& wanted);
    [[nodiscard]] bool has_file_of(const v1::Sector& sector) const;

    Connection& connection_;
    const std::string job_;
    const std::string folder_;
    std::set<std::pair<std::int32_t, std::int32_t>> here_;  // sectors whose files are in the folder
    std::int64_t pulled_ = 0;
    std::int64_t unchanged_ = 0;
    std::int64_t unfinished_ = 0;
};

}  // namespace drtv::client
