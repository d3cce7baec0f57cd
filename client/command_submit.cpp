#include "client/command_submit.h"

#include "client/command_watch.h"
#include "client/folder_pull.h"
#include "client/interrupt.h"
#include "client/job_text.h"
#include "client/number_text.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <cstdio>
#include <random>

namespace drtv::client {
namespace {

std::string random_id() {
    std::random_device random;
    std::string id;
    for (int n = 0; n < 4; ++n)
        id += fmt::format("{:08x}", random());
    return id;
}

void print_submitted(const Connection& connection, const v1::Job& job) {
    if (connection.options.json) {
        std::puts(json_line(job).c_str());
    } else {
        const std::string number = job_number(job);
        std::printf("job %s: %s sectors%s; watch it with: bake watch %s\n",
                    number.c_str(),
                    with_thousands(job.sectors_total()).c_str(),
                    reused_text(job).c_str(),
                    number.c_str());
    }
    for (const std::string& warning : job.warnings())
        warn(warning);
}

// Files come while the rest is still being baked.
int watch_and_pull(Connection& connection, const std::string& job, const std::string& folder) {
    FolderPull pull(connection, job, folder);
    tl::expected<void, std::string> pulled;
    std::int64_t done = 0;
    const auto pull_new = [&](const v1::Job& now) {
        if (!pulled || now.sectors_done() == done)
            return;
        done = now.sectors_done();
        pulled = pull.pull();
    };
    const int watched = run_watch(connection, job, pull_new);
    if (watched == exit_interrupted)
        return watched;
    if (pulled)
        pulled = pull.pull();
    if (!pulled)
        return complain(pulled.error());
    pull.report();
    return watched;
}

}  // namespace

int run_submit(Connection& connection, const SubmitOptions& options) {
    const auto job = prepare_job(connection, options);
    if (!job)
        return complain(job.error());
    v1::CreateJobRequest request;
    *request.mutable_job() = *job;
    request.set_request_id(random_id());
    grpc::ClientContext context;
    v1::Job created;
    if (const grpc::Status status = connection.jobs->CreateJob(&context, request, &created); !status.ok())
        return complain(connection.sentence(status));

    if (created.sectors_total() == 0)
        warn("the map has no ground, so there is nothing to bake");
    const std::string number = job_number(created);
    if (!options.pull_folder.empty())
        return watch_and_pull(connection, number, options.pull_folder);
    if (options.wait)
        return run_watch(connection, number);
    print_submitted(connection, created);
    return 0;
}

}  // namespace drtv::client
