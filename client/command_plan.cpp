#include "client/commands.h"
#include "client/job_text.h"
#include "client/map_files.h"
#include "client/plan_picture.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace drtv::client {
namespace {

// Reasons that are told, of the first sectors to be baked; --json tells all.
constexpr std::int64_t most_reasons = 20;

const char* name_of(v1::PlannedSector::Verdict verdict) {
    if (verdict == v1::PlannedSector::HIT)
        return "hit";
    return verdict == v1::PlannedSector::NEAR_HIT ? "near hit" : "rebake";
}

std::int64_t count(const v1::Plan& plan, v1::PlannedSector::Verdict verdict) {
    return std::count_if(plan.sectors().begin(), plan.sectors().end(), [&](const v1::PlannedSector& sector) {
        return sector.verdict() == verdict;
    });
}

void print_json(const v1::Plan& plan, double largest_bound) {
    using Json = nlohmann::ordered_json;
    Json sectors = Json::array(), changes = Json::array();
    for (const v1::PlannedSector& sector : plan.sectors()) {
        Json json = {{"sector", {sector.i(), sector.j()}}, {"verdict", name_of(sector.verdict())}};
        if (sector.bound() > 0)
            json["bound"] = sector.bound();
        if (!sector.reason().empty())
            json["reason"] = sector.reason();
        if (sector.verdict() == v1::PlannedSector::REBAKE)
            json["share"] = sector.share();
        sectors.push_back(std::move(json));
    }
    for (const v1::MapChange& change : plan.changes())
        changes.push_back({{"what", change.what()},
                           {"low", {change.x0(), change.y0(), change.z0()}},
                           {"high", {change.x1(), change.y1(), change.z1()}}});
    const Json json = {{"sectors_total", plan.sectors_size()},
                       {"hits", count(plan, v1::PlannedSector::HIT)},
                       {"near_hits", count(plan, v1::PlannedSector::NEAR_HIT)},
                       {"rebakes", count(plan, v1::PlannedSector::REBAKE)},
                       {"largest_bound", largest_bound},
                       {"seconds", plan.seconds()},
                       {"changes", std::move(changes)},
                       {"sectors", std::move(sectors)}};
    std::puts(json.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
}

void print_text(const v1::Plan& plan, double largest_bound) {
    const std::int64_t hits = count(plan, v1::PlannedSector::HIT),
                       near_hits = count(plan, v1::PlannedSector::NEAR_HIT),
                       rebakes = count(plan, v1::PlannedSector::REBAKE);
    std::string text = fmt::format("{} sectors: {} hits, {} near hits",
                                   with_thousands(plan.sectors_size()),
                                   with_thousands(hits),
                                   with_thousands(near_hits));
    if (near_hits > 0)
        text += fmt::format(" (at most {:.2g} % off)", largest_bound * 100);
    text += fmt::format(", {} to bake", with_thousands(rebakes));
    if (rebakes > 0 && plan.seconds() > 0)
        text += fmt::format(", about {}", duration_text(plan.seconds()));
    std::puts(text.c_str());
    std::int64_t told = 0;
    for (const v1::PlannedSector& sector : plan.sectors()) {
        if (sector.verdict() != v1::PlannedSector::REBAKE)
            continue;
        if (++told > most_reasons)
            break;
        const std::string share =
            sector.share() >= 1  ? ""
            : sector.share() > 0 ? fmt::format("; {:.0f} % of its probes", std::ceil(sector.share() * 100))
                                 : "; those that move";
        std::printf("  (%d, %d) %s%s\n", sector.i(), sector.j(), sector.reason().c_str(), share.c_str());
    }
    if (rebakes > most_reasons)
        std::printf("  and %s more; --json lists all\n", with_thousands(rebakes - most_reasons).c_str());
}

}  // namespace

int run_plan(Connection& connection, const SubmitOptions& options, const std::string& picture) {
    const auto job = prepare_job(connection, options);
    if (!job)
        return complain(job.error());
    v1::PlanJobRequest request;
    *request.mutable_job() = *job;
    grpc::ClientContext context;
    v1::Plan plan;
    if (const grpc::Status status = connection.jobs->PlanJob(&context, request, &plan); !status.ok())
        return complain(connection.sentence(status));
    for (const std::string& warning : plan.warnings())
        std::fprintf(stderr, "bake: warning: %s\n", warning.c_str());
    double largest_bound = 0;
    for (const v1::PlannedSector& sector : plan.sectors())
        largest_bound = std::max(largest_bound, sector.bound());
    if (connection.options.json)
        print_json(plan, largest_bound);
    else
        print_text(plan, largest_bound);
    if (picture.empty())
        return 0;
    if (auto written = write_plan_picture(plan, picture); !written)
        return complain(written.error());
    if (!connection.options.json)
        std::printf("%s: green hits, yellow near hits, red to bake, blue what changed\n", picture.c_str());
    return 0;
}

}  // namespace drtv::client
