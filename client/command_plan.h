// bake plan: what would be baked, and why.
#pragma once

#include "client/connection.h"
#include "client/job_request.h"

#include <string>

namespace drtv::client {

struct PlanPicture {
    std::string path;   // of the PNG to write; empty: none
    std::string under;  // of a picture that lies under the plan; empty: none
};

// Prints the plan, and draws it where that is asked for. Gives the exit status.
cli::Result<cli::ExitCode> run_plan(ServerConnection& connection,
                                    const SubmitOptions& options,
                                    const PlanPicture& picture);

}  // namespace drtv::client
