#include "client/command_pull.h"

#include "client/folder_pull.h"
#include "client/whole_file.h"

namespace drtv::client {

int run_pull(Connection& connection, const std::string& job, const std::string& folder) {
    if (auto made = make_folder(folder); !made)
        return complain(made.error());
    FolderPull pull(connection, job, folder);
    if (auto pulled = pull.pull(); !pulled)
        return complain(pulled.error());
    pull.report();
    return 0;
}

}  // namespace drtv::client
