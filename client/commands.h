// The subcommands. Each gives the process's exit status.
#pragma once

#include "client/connection.h"

#include <map>
#include <string>
#include <vector>

namespace drtv::client {

struct SubmitOptions {
    std::vector<std::string> maps;
    std::string region;  // "X0,Y0,X1,Y1", or empty
    std::string preset = "console";
    std::vector<std::string> settings;  // "key=value"
    bool wait = false;
    std::string pull_folder;
};

int run_submit(Connection& connection, const SubmitOptions& options);
int run_list(Connection& connection);
int run_status(Connection& connection, const std::string& job);
int run_cancel(Connection& connection, const std::string& job);
int run_watch(Connection& connection, const std::string& job);
int run_pull(Connection& connection, const std::string& job, const std::string& folder);

// The folder and those above it; a sentence when it cannot be had.
[[nodiscard]] tl::expected<void, std::string> make_folder(const std::string& folder);

// Exit status for ctrl-C, as shells count.
inline constexpr int exit_interrupted = 130;

// Set by ctrl-C once `catch_interrupt` has been called.
void catch_interrupt();
[[nodiscard]] bool interrupted();

// Uploads what the server lacks of a map and creates it. Gives its resource name.
struct LocalMap;
[[nodiscard]] tl::expected<v1::Map, std::string> upload_map(Connection& connection, const LocalMap& map);

}  // namespace drtv::client
