// The subcommands. Each gives the process's exit status.
#pragma once

#include "client/connection.h"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace drtv::client {

struct SubmitOptions {
    std::vector<std::string> maps;
    std::string region;  // "X0,Y0,X1,Y1", or empty
    std::string preset = "console";
    std::vector<std::string> settings;  // "key=value"
    bool exact = false;                 // tolerance=0
    bool wait = false;
    std::string pull_folder;
};

int run_submit(Connection& connection, const SubmitOptions& options);
// With `picture`, a PNG is written there too.
int run_plan(Connection& connection, const SubmitOptions& options, const std::string& picture);
int run_cache(Connection& connection, bool clear);
int run_list(Connection& connection);
int run_status(Connection& connection, const std::string& job);
int run_cancel(Connection& connection, const std::string& job);
// `progressed` is told of the job now and again.
int run_watch(Connection& connection,
              const std::string& job,
              const std::function<void(const v1::Job&)>& progressed = {});
int run_pull(Connection& connection, const std::string& job, const std::string& folder);

// The folder and those above it; a sentence when it cannot be had.
[[nodiscard]] tl::expected<void, std::string> make_folder(const std::string& folder);

// Exit status for ctrl-C, as shells count.
inline constexpr int exit_interrupted = 130;

// Set by ctrl-C once `catch_interrupt` has been called.
void catch_interrupt();
[[nodiscard]] bool interrupted();

// Checks the options, uploads the map, and gives the job that they ask for.
[[nodiscard]] tl::expected<v1::Job, std::string> prepare_job(Connection& connection,
                                                             const SubmitOptions& options);

// Pulls the finished files of a job into a folder, as often as asked: each file once.
class FolderPull {
  public:
    FolderPull(Connection& connection, const std::string& job, std::string folder);
    // Those that have been finished since.
    [[nodiscard]] tl::expected<void, std::string> pull();
    // What was done, on standard output.
    void report() const;

  private:
    Connection& connection_;
    const std::string job_, folder_;
    std::set<std::pair<std::int32_t, std::int32_t>> here_;  // sectors whose files are in the folder
    std::int64_t pulled_ = 0, unchanged_ = 0, unfinished_ = 0;
};

// Uploads what the server lacks of a map and creates it. Gives its resource name.
struct LocalMap;
[[nodiscard]] tl::expected<v1::Map, std::string> upload_map(Connection& connection, const LocalMap& map);

}  // namespace drtv::client
