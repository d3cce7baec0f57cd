#include "client/command_list.h"

#include "client/job_end.h"
#include "client/job_text.h"
#include "client/number_text.h"
#include "client/user_name.h"
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
    std::printf("%5s  %-9s  %-19s  %13s  %9s  %-16s  %-10s  %s\n",
                "JOB",
                "STATE",
                "CREATED",
                "SECTORS",
                "PROBES",
                "PRESET",
                "OWNER",
                "LABEL");
}

void print_row(const v1::Job& job) {
    const std::string preset =
        job.settings().preset() + (job.priority() == v1::Job::NIGHTLY ? ", nightly" : "");
    std::printf("%5s  %-9s  %-19s  %6lld/%6lld  %9s  %-16s  %-10s  %s\n",
                job_number(job).c_str(),
                state_name(job.state()).c_str(),
                local_time(job.create_time().seconds()).c_str(),
                static_cast<long long>(job.sectors_done()),
                static_cast<long long>(job.sectors_total()),
                with_thousands(job.probes()).c_str(),
                preset.c_str(),
                job.owner().c_str(),
                job.label().c_str());
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

template <class Request>
Request named(const std::string& job) {
    Request request;
    request.set_name(job_resource(job));
    return request;
}

// Asks for something to be done with a job, and prints it as it is then.
template <class Request>
cli::Result<cli::ExitCode> change(ServerConnection& connection,
                                  grpc::Status (v1::Jobs::Stub::*method)(grpc::ClientContext*,
                                                                         const Request&,
                                                                         v1::Job*),
                                  const Request& request) {
    v1::Job changed;
    if (const grpc::Status status = call(*connection.jobs, method, request, changed); !status.ok())
        return tl::unexpected(connection.failure(status));
    print(connection, changed);
    return cli::exit_done;
}

}  // namespace

cli::Result<cli::ExitCode> run_list(ServerConnection& connection, bool mine) {
    const bool as_json = connection.options.json;
    v1::ListJobsRequest request;
    if (mine)
        request.set_owner(user_name());
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
    return change(connection, &v1::Jobs::Stub::RetryJob, named<v1::RetryJobRequest>(job));
}

cli::Result<cli::ExitCode> run_raise(ServerConnection& connection, const std::string& job) {
    return change(connection, &v1::Jobs::Stub::RaiseJob, named<v1::RaiseJobRequest>(job));
}

cli::Result<cli::ExitCode> run_hold(ServerConnection& connection, const std::string& job) {
    return change(connection, &v1::Jobs::Stub::HoldJob, named<v1::HoldJobRequest>(job));
}

cli::Result<cli::ExitCode> run_release(ServerConnection& connection, const std::string& job) {
    return change(connection, &v1::Jobs::Stub::ReleaseJob, named<v1::ReleaseJobRequest>(job));
}

cli::Result<cli::ExitCode> run_cancel(ServerConnection& connection, const std::string& job) {
    v1::Job cancelled;
    const auto request = named<v1::CancelJobRequest>(job);
    if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::CancelJob, request, cancelled);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    if (cancelled.state() != v1::Job::CANCELLED && has_ended(cancelled))
        cli::note("the job had ended before: nothing was cancelled");
    print(connection, cancelled);
    return cli::exit_done;
}

}  // namespace drtv::client
