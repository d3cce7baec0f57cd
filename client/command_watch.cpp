#include "client/command_watch.h"

#include "client/interrupt.h"
#include "client/job_end.h"
#include "client/job_text.h"
#include "client/number_text.h"
#include "client/progress.h"
#include "client/read_report.h"
#include "client/reconnection.h"
#include "format/cli/report.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <cstdio>
#include <set>

namespace drtv::client {
namespace {

std::string progress_text(const v1::Job& job) {
    std::string text = fmt::format("{}/{} sectors  {} probes",
                                   with_thousands(job.sectors_done()),
                                   with_thousands(job.sectors_total()),
                                   with_thousands(job.probes()));
    if (job.rays_per_second() > 0) {
        const double million_rays = in_millions(job.rays_per_second());
        const std::string left = duration_text(job.seconds_left());
        text += fmt::format("  {:.2f} Mrays/s  {} left", million_rays, left);
    }
    if (job.has_cluster())
        text += "  " + cluster_text(job.cluster());
    if (job.sectors_failed() > 0)
        text += fmt::format("  {} failed", job.sectors_failed());
    return text;
}

double share_ended(const v1::Job& job) {
    if (job.sectors_total() == 0)
        return 1;
    const std::int64_t ended = job.sectors_done() + job.sectors_failed();
    return static_cast<double>(ended) / static_cast<double>(job.sectors_total());
}

grpc::Status follow(ServerConnection& connection,
                    const std::string& name,
                    Progress& progress,
                    const WatchOptions& options,
                    const std::string& left,
                    v1::Job& last,
                    bool& heard) {
    v1::WatchJobRequest request;
    request.set_name(name);
    grpc::ClientContext context;
    const InterruptGuard guard(context, left);
    const auto reader = connection.jobs->WatchJob(&context, request);
    v1::Job job;
    std::string told_trouble;
    while (reader->Read(&job)) {
        last = job;
        heard = true;
        const std::string& trouble = job.cluster().trouble();
        if (!trouble.empty() && trouble != told_trouble && !options.quiet) {
            progress.clear();
            cli::note("the cluster: " + trouble);
        }
        told_trouble = trouble;
        if (options.progressed)
            options.progressed(job);
        if (options.quiet || has_ended(job))
            continue;
        if (connection.options.json) {
            std::puts(json_line(job).c_str());
        } else {
            progress.show(share_ended(job), progress_text(job));
        }
    }
    return reader->Finish();
}

}  // namespace

cli::Result<v1::Job> watch_job(ServerConnection& connection,
                               const std::string& argument,
                               const WatchOptions& options) {
    const std::string name = job_resource(argument);
    const std::string number = name.substr(name.find('/') + 1);
    const std::string come_back = "come back with: bake watch " + number;
    const std::string left = fmt::format("job {} goes on without this client; {}", number, come_back);
    Progress progress;
    v1::Job job;
    Reconnection reconnection(connection.options.server);
    bool is_lost = false;
    for (;;) {
        bool heard = false;
        const grpc::Status status = follow(connection, name, progress, options, left, job, heard);
        progress.clear();
        if (interrupted())
            return cli::fail(cli::exit_interrupted, left);
        if (has_ended(job))
            break;
        const bool is_away = status.error_code() == grpc::StatusCode::UNAVAILABLE;
        is_lost = is_away || (is_lost && !heard);
        const bool goes_on = is_away && !job.name().empty() && reconnection.try_again(heard);
        if (goes_on)
            continue;
        if (time_is_over()) {
            const std::string what =
                is_lost ? fmt::format("bakerd at {} is away, and job {} had not ended before",
                                      connection.options.server,
                                      number)
                        : fmt::format("job {} goes on", number);
            return cli::fail(cli::exit_timeout, fmt::format("the time is over: {}; {}", what, come_back));
        }
        return tl::unexpected(connection.failure(status));
    }
    return job;
}

cli::Result<cli::ExitCode> tell_end(const ServerConnection& connection, const v1::Job& job) {
    const auto read = read_report(connection, job);
    if (!read && interrupted())
        return tl::unexpected(read.error());
    if (!read)
        cli::warn(fmt::format("the warnings of the job's sectors are not known: {}", read.error().sentence));
    const JobReport& report = read ? *read : JobReport();
    std::set<std::string> told(cli::warnings_told().begin(), cli::warnings_told().end());
    const auto warn_once = [&](const std::string& warning) {
        if (told.insert(warning).second)
            cli::warn(warning);
    };
    std::ranges::for_each(job.warnings(), warn_once);
    std::ranges::for_each(report.map_warnings, warn_once);
    std::int64_t untold = 0;
    for (const auto& [thing, of_thing] : report.warnings) {
        for (const JobReport::Warning& warning : of_thing) {
            if (connection.options.json)
                warn_once(warning.sentence);
            else
                untold += told.contains(warning.sentence) ? 0 : 1;
        }
    }
    if (untold > 0)
        cli::note(fmt::format(
            "{}: bake report {}", counted(untold, "more warning", "more warnings"), job_number(job)));
    std::puts((connection.options.json ? json_line(job, read ? &report : nullptr) : one_line(job)).c_str());
    return end_of(job);
}

cli::Result<cli::ExitCode> run_watch(ServerConnection& connection,
                                     const std::string& argument,
                                     const WatchOptions& options) {
    const auto job = watch_job(connection, argument, options);
    if (!job)
        return tl::unexpected(job.error());
    return tell_end(connection, *job);
}

}  // namespace drtv::client
