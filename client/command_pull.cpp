#include "client/command_pull.h"

#include "client/folder_pull.h"
#include "client/job_end.h"
#include "format/folder/whole_file.h"

#include <grpcpp/grpcpp.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace drtv::client {
namespace {

cli::Result<cli::ExitCode> pull_into(ServerConnection& connection,
                                     const std::string& job,
                                     const std::string& folder,
                                     bool replace) {
    if (auto made = folder::make_folder(folder); !made)
        return tl::unexpected(made.error());
    // As it is before the files are asked for: what ends in the meantime is not missed then.
    const auto found = get_job(connection, job);
    if (!found)
        return tl::unexpected(found.error());
    v1::Map map;
    if (const grpc::Status status = find_map(connection, *found, map); !status.ok())
        return tl::unexpected(connection.failure(status));
    auto pull = FolderPull::open(connection, *found, std::move(map), folder, replace);
    if (!pull)
        return tl::unexpected(pull.error());
    if (auto pulled = pull->finish(); !pulled)
        return tl::unexpected(pulled.error());
    pull->report();
    return end_of(*found);
}

}  // namespace

cli::Result<cli::ExitCode> run_pull(ServerConnection& connection,
                                    const std::string& job,
                                    const std::string& folder,
                                    bool replace) {
    std::error_code code;
    const bool was_there = std::filesystem::exists(std::filesystem::symlink_status(folder, code));
    auto pulled = pull_into(connection, job, folder, replace);
    if (!pulled && !was_there)
        ::rmdir(folder.c_str());  // unless something is in it
    return pulled;
}

}  // namespace drtv::client
