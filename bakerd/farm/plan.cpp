#include "bakerd/farm/plan.h"

#include "bakerd/farm/result_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::farm {
namespace {

constexpr const char* lost = "its earlier result is lost";

// Sectors are baked in rings around changes; within one in the order in which they share scenes.
constexpr float ring_m = 192;

float distance_m(const map::SectorCoordinate& sector, const map::Bounds& bounds) {
    const auto side = static_cast<float>(map::sector_size_m);
    const float x = (static_cast<float>(sector.i) + 0.5f) * side;
    const float y = (static_cast<float>(sector.j) + 0.5f) * side;
    return std::hypot(x - std::clamp(x, bounds.low.x, bounds.high.x),
                      y - std::clamp(y, bounds.low.y, bounds.high.y));
}

// Around the nearest change.
float ring_of(const map::SectorCoordinate& sector, std::span<const worker::MapChange> changes) {
    float nearest_m = std::numeric_limits<float>::max();
    for (const worker::MapChange& change : changes)
        nearest_m = std::min(nearest_m, distance_m(sector, change.bounds));
    return std::floor(nearest_m / ring_m);
}

void reuse_result(PlannedSector& planned, ResultRow result, float bound) {
    planned.verdict = bound > 0 ? reuse::Verdict::near_hit : reuse::Verdict::hit;
    planned.reused = std::move(result);
    planned.bound = bound;
    planned.candidates.clear();
}

void warn(Plan& plan, std::string sentence) {
    if (plan.warnings.size() < worker::max_warnings)
        plan.warnings.push_back(std::move(sentence));
}

const char* reason_of(const CacheEntry& entry) {
    if (!entry.candidates.empty())
        return "its earlier results were not looked at";
    return entry.lost ? lost : "it was not baked with these settings before";
}

}  // namespace

std::int64_t Plan::count(reuse::Verdict verdict) const {
    return std::ranges::count(sectors, verdict, &PlannedSector::verdict);
}

store::Result<Plan> look_up(ResultCache& cache,
                            std::span<const map::SectorCoordinate> sectors,
                            const CacheQuery& query,
                            CachePin& pin) {
    const auto mean_seconds = cache.mean_seconds(query.results_key);
    if (!mean_seconds)
        return tl::unexpected(mean_seconds.error());
    auto entries = cache.find(sectors, query, pin);
    if (!entries)
        return tl::unexpected(entries.error());
    Plan plan;
    for (std::size_t n = 0; n < sectors.size(); ++n) {
        CacheEntry& entry = (*entries)[n];
        PlannedSector& planned = plan.sectors.emplace_back();
        planned.sector = sectors[n];
        planned.seconds = *mean_seconds;
        if (!entry.warning.empty())
            warn(plan, entry.warning);
        if (entry.held) {
            reuse_result(planned, std::move(*entry.held), entry.bound);
            continue;
        }
        planned.reason = planned.cause = reason_of(entry);
        planned.candidates = std::move(entry.candidates);
        if (!planned.candidates.empty())
            planned.seconds = planned.candidates.front().result.seconds;
    }
    return plan;
}

std::optional<worker::AssessRequest> make_assess_request(const Plan& plan,
                                                         const Digest& manifest,
                                                         const settings::JobSettings& settings) {
    worker::AssessRequest request{manifest, settings, {}};
    for (const PlannedSector& planned : plan.sectors) {
        if (planned.candidates.empty())
            continue;
        worker::AssessRequest::Sector& asked = request.sectors.emplace_back();
        asked.sector = planned.sector;
        for (const ResultRow& row : planned.candidates)
            asked.candidates.push_back(row.result.blobs);
    }
    if (request.sectors.empty())
        return std::nullopt;
    return request;
}

void merge_answer(const worker::Assessments& answer, Plan& plan) {
    std::size_t next = 0;
    for (PlannedSector& planned : plan.sectors) {
        if (planned.candidates.empty() || next >= answer.sectors.size())
            continue;
        const worker::Assessments::Sector& assessed = answer.sectors[next++];
        planned.reason = assessed.reason;
        planned.cause = assessed.cause;
        if (assessed.candidate >= planned.candidates.size())
            continue;
        const ResultRow candidate = planned.candidates[assessed.candidate];
        if (assessed.verdict != reuse::Verdict::rebake) {
            reuse_result(planned, candidate, assessed.bound);
        } else if (assessed.share < 1) {
            planned.earlier = candidate;
            planned.share = assessed.share;
            // Where probes are placed again some may come to stand elsewhere.
            const double share = std::max(static_cast<double>(assessed.share), 0.02);
            planned.seconds = candidate.result.seconds * share;
        }
    }
    plan.changes = answer.changes;
    for (const std::string& warning : answer.warnings)
        warn(plan, warning);
    if (plan.changes.empty())
        return;
    for (PlannedSector& planned : plan.sectors)
        planned.ring = ring_of(planned.sector, plan.changes);
    std::ranges::stable_sort(plan.sectors, {}, &PlannedSector::ring);
}

void drop_damaged(store::BlobStore& blobs, Plan& plan) {
    for (PlannedSector& planned : plan.sectors) {
        if (!planned.reused)
            continue;
        const auto bytes = blobs.get(planned.reused->result.blobs.file);
        if (bytes)
            continue;
        planned.verdict = reuse::Verdict::rebake;
        planned.reused.reset();
        planned.bound = 0;
        planned.reason = planned.cause = lost;
        warn(plan,
             fmt::format("sector ({}, {}): an earlier result cannot be used: {}",
                         planned.sector.i,
                         planned.sector.j,
                         bytes.error().message));
    }
}

}  // namespace drtv::farm
