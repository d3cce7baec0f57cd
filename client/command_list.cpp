#include "client/command_list.h"

#include "client/job_end.h"
#include "client/job_text.h"
#include "client/number_text.h"
#include "format/cli/report.h"

#include <grpcpp/grpcpp.h>

#include <cstdio>
#include <ctime>

namespace drtv::client {
namespace {

std::string local_time(std::int64_t unix_seconds) {
    const std::time_t time = unix_seconds;
    std::tm parts{};
    char text[32] = "";
    if (::localtime_r(&time, &parts) != nullptr)
        std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts);
    return text;
}

void print_heading() {
    std::printf(
        "%5s  %-9s  %-19s  %13s  %9s  %s\n", "JOB", "STATE", "CREATED", "SECTORS", "PROBES", "PRESET");
}

void print_row(const v1::Job& job) {
    std::printf("%5s  %-9s  %-19s  %6lld/%6lld  %9s  %s%s\n",
                job_number(job).c_str(),
                state_name(job.state()).c_str(),
                local_time(job.create_time().seconds()).c_str(),
                static_cast<long long>(job.sectors_done()),
                static_cast<long long>(job.sectors_total()),
                with_thousands(job.probes()).c_str(),
                job.settings().preset().c_str(),
                job.priority() == v1::Job::NIGHTLY ? ", nightly" : "");
}

void print(const ServerConnection& connection, const v1::Job& job) {
    if (connection.options.json) {
        std::puts(json_line(job).c_str());
        return;
    }
    std::puts(one_line(job).c_str());
    if (!job.error().empty())
        std::printf("  %s\n", job.error().c_str());
}

}  // namespace

cli::Result<cli::ExitCode> run_list(ServerConnection& connection) {
    const bool as_json = connection.options.json;
    v1::ListJobsRequest request;
    for (;;) {
        v1::ListJobsResponse response;
        if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::ListJobs, request, response);
            !status.ok())
            return tl::unexpected(connection.failure(status));
        const bool is_first_page = request.page_token().empty();
        if (!as_json && is_first_page)
            print_heading();
        for (const v1::Job& job : response.jobs()) {
            if (as_json)
                std::puts(json_line(job).c_str());
            else
                print_row(job);
        }
        if (response.next_page_token().empty())
            return cli::exit_done;
        request.set_page_token(response.next_page_token());
    }
}

cli::Result<cli::ExitCode> run_status(ServerConnection& connection, const std::string& job) {
    const auto found = get_job(connection, job);
    if (!found)
        return tl::unexpected(found.error());
    print(connection, *found);
    return cli::exit_done;
}

cli::Result<cli::ExitCode> run_retry(ServerConnection& connection, const std::string& job) {
    v1::RetryJobRequest request;
    request.set_name(job_resource(job));
    v1::Job retried;
    if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::RetryJob, request, retried);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    print(connection, retried);
    return cli::exit_done;
}

cli::Result<cli::ExitCode> run_cancel(ServerConnection& connection, const std::string& job) {
    v1::CancelJobRequest request;
    request.set_name(job_resource(job));
    v1::Job cancelled;
    if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::CancelJob, request, cancelled);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    if (cancelled.state() != v1::Job::CANCELLED && has_ended(cancelled))
        cli::note("the job had ended before: nothing was cancelled");
    print(connection, cancelled);
    return cli::exit_done;
}

}  // namespace drtv::client
