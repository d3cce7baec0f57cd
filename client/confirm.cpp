#include "client/confirm.h"

#include "client/interrupt.h"
#include "client/number_text.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>

namespace drtv::client {
namespace {

// 3.2 km x 3.2 km.
constexpr std::int64_t max_unasked = 2500;

bool is_agreed(const std::string& question) {
    std::fprintf(stderr, "bake: %s: go on? [y/N] ", question.c_str());
    std::string answer;
    return std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes");
}

}  // namespace

cli::Result<void> confirm_size(ServerConnection& connection, const PreparedJob& prepared, bool yes) {
    // A plan costs time: it is made only where it can matter.
    if (yes || prepared.map.sector_count() <= max_unasked)
        return {};
    v1::PlanJobRequest request;
    *request.mutable_job() = prepared.job;
    v1::Plan plan;
    if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::PlanJob, request, plan);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    const std::int64_t to_bake = std::ranges::count(
        plan.sectors(), v1::PlannedSector::REBAKE, [](const auto& sector) { return sector.verdict(); });
    if (to_bake <= max_unasked)
        return {};
    const std::string time =
        plan.seconds() > 0 ? fmt::format(", which takes about {}", duration_text(plan.seconds())) : "";
    const std::string size = fmt::format("the job bakes {} sectors{}", with_thousands(to_bake), time);
    if (::isatty(STDIN_FILENO) != 1 || ::isatty(STDERR_FILENO) != 1)
        return cli::fail(
            cli::exit_usage,
            fmt::format("{}, more than {}: say --yes where that is meant, or --region X0,Y0,X1,Y1 for a part",
                        size,
                        with_thousands(max_unasked)));
    if (is_agreed(size))
        return {};
    return cli::fail(interrupted() ? cli::exit_interrupted : cli::exit_usage, "nothing was submitted");
}

}  // namespace drtv::client
