#include "client/command_pull.h"

#include "client/folder_pull.h"
#include "client/job_end.h"
#include "client/whole_file.h"

namespace drtv::client {

cli::Result<cli::ExitCode> run_pull(ServerConnection& connection,
                                    const std::string& job,
                                    const std::string& folder) {
    if (auto made = make_folder(folder); !made)
        return tl::unexpected(made.error());
    // As it is before the files are asked for: what ends in the meantime is not missed then.
    const auto found = get_job(connection, job);
    if (!found)
        return tl::unexpected(found.error());
    FolderPull pull(connection, job, folder);
    if (auto pulled = pull.pull(); !pulled)
        return tl::unexpected(pulled.error());
    pull.report();
    return end_of(*found);
}

}  // namespace drtv::client
