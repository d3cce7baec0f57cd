#include "client/job_end.h"

#include "client/job_text.h"
#include "client/number_text.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

namespace drtv::client {

cli::Result<v1::Job> get_job(ServerConnection& connection, const std::string& job) {
    v1::GetJobRequest request;
    request.set_name(job_resource(job));
    v1::Job found;
    if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::GetJob, request, found);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    return found;
}

grpc::Status find_map(const ServerConnection& connection, const v1::Job& job, v1::Map& map) {
    v1::GetMapRequest request;
    request.set_name(job.map());
    return call(*connection.maps, &v1::Maps::Stub::GetMap, request, map);
}

cli::Result<cli::ExitCode> end_of(const v1::Job& job) {
    if (job.state() == v1::Job::SUCCEEDED && job.sectors_total() > 0 && job.probes() == 0) {
        return cli::fail(
            cli::exit_invalid,
            "no probe was placed: no column of the lattice, every 4 m, meets ground that faces up, "
            "with 1.5 m of air above it; is the map too small, on its side, or inside out?");
    }
    if (job.state() == v1::Job::SUCCEEDED)
        return cli::exit_done;
    if (job.state() == v1::Job::FAILED)
        return cli::fail(cli::exit_job_failed, job.error());
    const bool cancelled = job.state() == v1::Job::CANCELLED;
    return cli::fail(cli::exit_unfinished,
                     fmt::format("job {} {}: {} of {} sectors are done",
                                 job_number(job),
                                 cancelled ? "was cancelled" : "is not finished",
                                 with_thousands(job.sectors_done()),
                                 with_thousands(job.sectors_total())));
}

}  // namespace drtv::client
