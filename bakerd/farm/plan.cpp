#include "bakerd/farm/plan.h"

#include "bakerd/reuse/footprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::farm {
namespace {

// Of one sector: branches of a map, and steps back.
constexpr std::size_t most_candidates = 8;

constexpr std::size_t most_warnings = 20;
constexpr const char* lost = "its earlier result is lost";

// Sectors are baked in rings around changes; within one in the order in which they share scenes.
constexpr float ring_m = 192;

float distance_m(const map::SectorCoordinate& sector, const map::Bounds& bounds) {
    const auto side = static_cast<float>(map::sector_size_m);
    const float x = (static_cast<float>(sector.i) + 0.5f) * side,
                y = (static_cast<float>(sector.j) + 0.5f) * side;
    return std::hypot(x - std::clamp(x, bounds.low.x, bounds.high.x),
                      y - std::clamp(y, bounds.low.y, bounds.high.y));
}

void reuse(PlannedSector& planned, const BakeAnswer& result, float bound) {
    planned.verdict = bound > 0 ? reuse::Verdict::near_hit : reuse::Verdict::hit;
    planned.reused = result;
    planned.bound = bound;
    planned.candidates.clear();
}

}  // namespace

std::int64_t Plan::count(reuse::Verdict verdict) const {
    return std::ranges::count(sectors, verdict, &PlannedSector::verdict);
}

Digest task_key(const Digest& content, const bake::Settings& settings, map::SectorCoordinate sector) {
    map::Hasher hasher;
    hasher.add_sized(std::string_view("drtv task"));
    hasher.add(content);
    hasher.add(reuse::results_key(settings));
    hasher.add(sector.i);
    hasher.add(sector.j);
    if (settings.tolerance > 0)
        hasher.add(settings.tolerance);
    return hasher.finish();
}

Result<Plan> look_up(Database& database,
                     const BlobStore& blobs,
                     const InspectAnswer& map,
                     const bake::Settings& settings,
                     const std::vector<map::SectorCoordinate>& sectors) {
    bake::Settings exact = settings;
    exact.tolerance = 0;
    const Digest results_key = reuse::results_key(settings);
    const auto mean_seconds = database.mean_seconds(results_key);
    if (!mean_seconds)
        return tl::unexpected(mean_seconds.error());
    Plan plan;
    for (const map::SectorCoordinate& sector : sectors) {
        PlannedSector& planned = plan.sectors.emplace_back();
        planned.sector = sector;
        planned.seconds = *mean_seconds;
        for (const bake::Settings& asked : {exact, settings}) {
            const auto task = database.task_by_key(task_key(map.content, asked, sector));
            if (!task)
                return tl::unexpected(task.error());
            if (!*task || (*task)->state != TaskState::done || !blobs.has((*task)->result.result))
                continue;
            reuse(planned, (*task)->result, (*task)->bound);
            break;
        }
        if (planned.reused)
            continue;
        auto rows = database.results(sector, results_key, most_candidates);
        if (!rows)
            return tl::unexpected(rows.error());
        for (ResultRow& row : *rows) {
            if (!blobs.has(row.result.result))
                continue;
            if (row.result.inventory == map.inventory && row.result.bound <= settings.tolerance) {
                reuse(planned, row.result, row.result.bound);
                break;
            }
            if (planned.candidates.empty())
                planned.seconds = row.result.seconds;
            planned.candidates.push_back(std::move(row));
        }
        if (planned.reused)
            continue;
        planned.reason = rows->empty()                ? "it was not baked with these settings before"
                         : planned.candidates.empty() ? lost
                                                      : "its earlier results were not looked at";
    }
    return plan;
}

std::optional<AssessRequest> question_of(const Plan& plan,
                                         const Digest& manifest,
                                         const bake::Settings& settings) {
    AssessRequest request{0, manifest, settings, {}};
    for (const PlannedSector& planned : plan.sectors) {
        if (planned.candidates.empty())
            continue;
        AssessRequest::Sector& asked = request.sectors.emplace_back();
        asked.sector = planned.sector;
        for (const ResultRow& row : planned.candidates)
            asked.candidates.push_back(digests_of(row.result));
    }
    if (request.sectors.empty())
        return std::nullopt;
    return request;
}

void apply(const AssessAnswer& answer, Plan& plan) {
    std::size_t next = 0;
    for (PlannedSector& planned : plan.sectors) {
        if (planned.candidates.empty() || next >= answer.sectors.size())
            continue;
        const AssessAnswer::Sector& assessed = answer.sectors[next++];
        planned.reason = assessed.reason;
        if (assessed.candidate >= planned.candidates.size())
            continue;
        const BakeAnswer& candidate = planned.candidates[assessed.candidate].result;
        if (assessed.verdict != reuse::Verdict::rebake) {
            reuse(planned, BakeAnswer(candidate), assessed.bound);
        } else if (assessed.share < 1) {
            planned.earlier = candidate;
            planned.share = assessed.share;
            // Where probes are placed again some may come to stand elsewhere.
            planned.seconds = candidate.seconds * std::max(static_cast<double>(assessed.share), 0.02);
        }
    }
    plan.changes = answer.changes;
    plan.warnings = answer.warnings;
    if (plan.changes.empty())
        return;
    std::ranges::stable_sort(plan.sectors, {}, [&](const PlannedSector& planned) {
        float nearest = std::numeric_limits<float>::max();
        for (const AssessAnswer::Change& change : plan.changes)
            nearest = std::min(nearest, distance_m(planned.sector, change.bounds));
        return std::floor(nearest / ring_m);
    });
}

void drop_damaged(BlobStore& blobs, Plan& plan) {
    for (PlannedSector& planned : plan.sectors) {
        if (!planned.reused)
            continue;
        const auto bytes = blobs.get(planned.reused->result);
        if (bytes)
            continue;
        planned.verdict = reuse::Verdict::rebake;
        planned.reused.reset();
        planned.bound = 0;
        planned.reason = lost;
        if (plan.warnings.size() < most_warnings)
            plan.warnings.push_back(fmt::format("sector ({}, {}): an earlier result cannot be used: {}",
                                                planned.sector.i,
                                                planned.sector.j,
                                                bytes.error().message));
    }
}

}  // namespace drtv::farm
