// The job that the options of `bake submit` and `bake plan` ask for.
#pragma once

#include "client/connection.h"
#include "format/cli/failure.h"
#include "settings/table.h"

#include <string>
#include <vector>

namespace drtv::client {

struct SubmitOptions {
    std::vector<std::string> maps;  // glTF files, or folders of them
    std::string region;             // "X0,Y0,X1,Y1", or empty
    std::string preset{settings::default_preset};
    std::vector<std::string> settings;    // "key=value"
    bool exact = false;                   // tolerance=0
    std::string priority{"interactive"};  // or "nightly"
    std::string label;
    bool wait = false;
    bool yes = false;         // a large job needs no question
    std::string pull_folder;  // empty: pull nothing
    bool replace = false;     // a folder of another map is taken too
    double timeout_s = 0;     // of --wait and --pull; 0: without a limit
};

struct PreparedJob {
    v1::Map map;
    v1::Job job;
};

// Checks the options, makes the folder to pull to, uploads the map, tells what it was understood to hold and
// what is doubtful in it, and gives the job.
[[nodiscard]] cli::Result<PreparedJob> prepare_job(ServerConnection& connection,
                                                   const SubmitOptions& options);

}  // namespace drtv::client
