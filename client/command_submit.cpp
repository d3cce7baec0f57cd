#include "client/command_submit.h"

#include "client/command_watch.h"
#include "client/confirm.h"
#include "client/folder_pull.h"
#include "client/interrupt.h"
#include "client/job_text.h"
#include "client/number_text.h"
#include "format/cli/report.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <cstdio>
#include <random>

namespace drtv::client {
namespace {

// For the files that are done when the time of --timeout is over.
constexpr double last_pull_s = 10;

std::string random_id() {
    std::random_device random;
    std::string id;
    for (int n = 0; n < 4; ++n)
        id += fmt::format("{:08x}", random());
    return id;
}

void print_submitted(const ServerConnection& connection, const v1::Job& job) {
    if (connection.options.json) {
        std::puts(json_line(job).c_str());
    } else {
        const std::string number = job_number(job);
        const std::string time =
            job.seconds_left() > 0 ? fmt::format(", about {}", duration_text(job.seconds_left())) : "";
        std::printf("job %s: %s%s%s; watch it with: bake watch %s\n",
                    number.c_str(),
                    counted(job.sectors_total(), "sector", "sectors").c_str(),
                    reused_text(job).c_str(),
                    time.c_str(),
                    number.c_str());
    }
    for (const std::string& warning : job.warnings())
        cli::warn(warning);
}

// Files come while the rest is still being baked.
cli::Result<cli::ExitCode> watch_and_pull(ServerConnection& connection,
                                          const v1::Job& created,
                                          const v1::Map& map,
                                          const SubmitOptions& options) {
    const std::string number = job_number(created);
    auto pull = FolderPull::open(connection, created, map, options.pull_folder, options.replace);
    if (!pull)
        return cli::fail(pull.error().code,
                         fmt::format("{}; job {} goes on, pull it with: bake pull {} --out {}",
                                     pull.error().sentence,
                                     number,
                                     number,
                                     options.pull_folder));
    cli::Result<void> pulled;
    std::int64_t done = 0;
    const auto pull_new = [&](const v1::Job& now) {
        if (!pulled || now.sectors_done() == done)
            return;
        done = now.sectors_done();
        pulled = pull->pull_new();
        // The end tries again.
        if (!pulled && pulled.error().may_pass)
            pulled = {};
    };
    limit_time(options.timeout_s);
    const auto job = watch_job(connection, number, {.progressed = pull_new});
    const std::string come_back =
        fmt::format("; its files: bake pull {} --out {}", number, options.pull_folder);
    if (!job && (job.error().code == cli::exit_interrupted || job.error().may_pass))
        return cli::fail(job.error().code, job.error().sentence + come_back);
    // For what is done by then.
    if (time_is_over())
        limit_time(last_pull_s);
    if (pulled)
        pulled = pull->finish();
    if (pulled)
        pull->report();
    // How the job ended says more than what became of its files.
    if (!job && !pulled)
        cli::warn(pulled.error().sentence);
    if (!job)
        return cli::fail(job.error().code, job.error().sentence + come_back);
    auto ended = tell_end(connection, *job);
    if (ended && !pulled)
        return tl::unexpected(pulled.error());
    if (!pulled)
        cli::warn(pulled.error().sentence);
    return ended;
}

}  // namespace

cli::Result<cli::ExitCode> run_submit(ServerConnection& connection, const SubmitOptions& options) {
    const auto prepared = prepare_job(connection, options);
    if (!prepared)
        return tl::unexpected(prepared.error());
    if (auto confirmed = confirm_size(connection, *prepared, options.yes); !confirmed)
        return tl::unexpected(confirmed.error());
    v1::CreateJobRequest request;
    *request.mutable_job() = prepared->job;
    request.set_request_id(random_id());
    v1::Job created;
    if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::CreateJob, request, created);
        !status.ok())
        return tl::unexpected(connection.failure(status));

    const std::string number = job_number(created);
    if (!created.settings().has_rays()) {
        return cli::fail(
            cli::exit_server,
            fmt::format("bakerd at {} is of another version than this bake: it does not say with which "
                        "settings it bakes job {}",
                        connection.options.server,
                        number));
    }
    if (!options.pull_folder.empty())
        return watch_and_pull(connection, created, prepared->map, options);
    if (options.wait) {
        limit_time(options.timeout_s);
        return run_watch(connection, number, {});
    }
    print_submitted(connection, created);
    return cli::exit_done;
}

}  // namespace drtv::client
