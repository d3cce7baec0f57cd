#include "client/command_plan.h"

#include "client/number_text.h"
#include "client/plan_picture.h"
#include "format/cli/report.h"
#include "format/image/png_file.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace drtv::client {
namespace {

// Reasons that are told, of the first sectors to be baked; --json tells all.
constexpr std::int64_t max_reasons = 20;

using Json = nlohmann::ordered_json;
using Verdict = v1::PlannedSector::Verdict;

const char* name_of(Verdict verdict) {
    if (verdict == v1::PlannedSector::HIT)
        return "hit";
    return verdict == v1::PlannedSector::NEAR_HIT ? "near hit" : "rebake";
}

std::int64_t count(const v1::Plan& plan, Verdict verdict) {
    const auto has_verdict = [&](const v1::PlannedSector& sector) { return sector.verdict() == verdict; };
    return std::count_if(plan.sectors().begin(), plan.sectors().end(), has_verdict);
}

double largest_bound_of(const v1::Plan& plan) {
    double largest = 0;
    for (const v1::PlannedSector& sector : plan.sectors())
        largest = std::max(largest, sector.bound());
    return largest;
}

Json json_of(const v1::PlannedSector& sector) {
    Json json;
    json["sector"] = {sector.i(), sector.j()};
    json["verdict"] = name_of(sector.verdict());
    if (sector.bound() > 0)
        json["bound"] = sector.bound();
    if (!sector.reason().empty())
        json["reason"] = sector.reason();
    if (sector.verdict() == v1::PlannedSector::REBAKE)
        json["share"] = sector.share();
    return json;
}

Json json_of(const v1::MapChange& change) {
    Json json;
    json["what"] = change.what();
    json["low"] = {change.x0(), change.y0(), change.z0()};
    json["high"] = {change.x1(), change.y1(), change.z1()};
    return json;
}

void print_json(const v1::Plan& plan) {
    Json json;
    json["kind"] = "plan";
    json["sectors_total"] = plan.sectors_size();
    json["hits"] = count(plan, v1::PlannedSector::HIT);
    json["near_hits"] = count(plan, v1::PlannedSector::NEAR_HIT);
    json["rebakes"] = count(plan, v1::PlannedSector::REBAKE);
    json["largest_bound"] = largest_bound_of(plan);
    json["seconds"] = plan.seconds();
    json["changes"] = Json::array();
    for (const v1::MapChange& change : plan.changes())
        json["changes"].push_back(json_of(change));
    json["sectors"] = Json::array();
    for (const v1::PlannedSector& sector : plan.sectors())
        json["sectors"].push_back(json_of(sector));
    std::puts(json.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
}

// How much of a sector to be baked is, when it is not all.
std::string share_text(double share) {
    if (share >= 1)
        return "";
    if (share > 0)
        return fmt::format("; {:.0f} % of its probes", std::ceil(share * 100));
    return "; those that move";
}

void print_reasons(const v1::Plan& plan) {
    std::int64_t rebakes = 0;
    for (const v1::PlannedSector& sector : plan.sectors()) {
        if (sector.verdict() != v1::PlannedSector::REBAKE)
            continue;
        if (++rebakes > max_reasons)
            continue;
        const std::string share = share_text(sector.share());
        std::printf("  (%d, %d) %s%s\n", sector.i(), sector.j(), sector.reason().c_str(), share.c_str());
    }
    if (rebakes > max_reasons)
        std::printf("  and %s more; --json lists all\n", with_thousands(rebakes - max_reasons).c_str());
}

void print_text(const v1::Plan& plan) {
    const std::int64_t hits = count(plan, v1::PlannedSector::HIT);
    const std::int64_t near_hits = count(plan, v1::PlannedSector::NEAR_HIT);
    const std::int64_t rebakes = count(plan, v1::PlannedSector::REBAKE);
    std::string text = fmt::format("{}: {}, {}",
                                   counted(plan.sectors_size(), "sector", "sectors"),
                                   counted(hits, "hit", "hits"),
                                   counted(near_hits, "near hit", "near hits"));
    if (near_hits > 0)
        text += fmt::format(" (at most {:.2g} % off)", largest_bound_of(plan) * 100);
    text += fmt::format(", {} to bake", with_thousands(rebakes));
    if (rebakes > 0 && plan.seconds() > 0)
        text += fmt::format(", about {}", duration_text(plan.seconds()));
    std::puts(text.c_str());
    print_reasons(plan);
}

}  // namespace

cli::Result<cli::ExitCode> run_plan(ServerConnection& connection,
                                    const SubmitOptions& options,
                                    const PlanPicture& picture) {
    std::optional<image::Underlay> under;
    if (!picture.path.empty()) {
        if (auto target = image::check_png_target(picture.path); !target)
            return tl::unexpected(target.error());
    }
    if (!picture.under.empty()) {
        auto read = image::Underlay::read(picture.under, picture.path);
        if (!read)
            return tl::unexpected(read.error());
        under = std::move(*read);
    }
    const auto prepared = prepare_job(connection, options);
    if (!prepared)
        return tl::unexpected(prepared.error());
    v1::PlanJobRequest request;
    *request.mutable_job() = prepared->job;
    v1::Plan plan;
    if (const grpc::Status status = call(*connection.jobs, &v1::Jobs::Stub::PlanJob, request, plan);
        !status.ok())
        return tl::unexpected(connection.failure(status));
    for (const std::string& warning : plan.warnings())
        cli::warn(warning);
    if (connection.options.json)
        print_json(plan);
    else
        print_text(plan);
    if (picture.path.empty())
        return cli::exit_done;
    if (auto written = write_plan_picture(plan, picture.path, under ? &*under : nullptr); !written)
        return tl::unexpected(written.error());
    if (!connection.options.json)
        std::printf("%s: the plan from above\n", picture.path.c_str());
    return cli::exit_done;
}

}  // namespace drtv::client
