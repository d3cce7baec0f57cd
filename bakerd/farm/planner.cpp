#include "bakerd/farm/planner.h"

#include "bakerd/farm/result_cache.h"

#include "bakerd/reuse/footprint.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace drtv::farm {

store::Result<PlannedJob> Planner::plan(const JobRequest& request, CachePin& pin) {
    const auto map = maps_.summary_of(request.manifest);
    if (!map)
        return tl::unexpected(map.error());
    const auto sectors = sectors_of(request.region, map->sectors);
    if (!sectors)
        return tl::unexpected(sectors.error());
    const CacheQuery query{
        reuse::results_key(request.settings.bake), map->inventory, request.settings.tolerance};
    auto plan = look_up(cache_, *sectors, query, pin);
    if (!plan)
        return tl::unexpected(plan.error());
    if (auto question = make_assess_request(*plan, request.manifest, request.settings)) {
        const auto answer = ask(std::move(*question));
        if (!answer && answer.error().may_retry)
            return store::fail(store::ErrorCode::unavailable, answer.error().sentence);
        if (answer)
            merge_answer(*answer, *plan);
        else  // all that is not known for certain is baked
            plan->warnings.push_back(
                fmt::format("older results could not be looked at: {}", answer.error().sentence));
    }
    drop_damaged(blobs_, *plan);
    for (const std::string& warning : plan->warnings)
        spdlog::warn("{}", warning);
    return PlannedJob{map->inventory, std::move(*plan)};
}

// In portions, so that other questions are answered in between.
executor::Reply<worker::Assessments> Planner::ask(worker::AssessRequest question) {
    constexpr std::size_t portion = 1000;
    worker::Assessments all;
    for (std::size_t first = 0; first < question.sectors.size(); first += portion) {
        const std::size_t end = std::min(first + portion, question.sectors.size());
        worker::AssessRequest part{question.manifest, question.settings, {}};
        part.sectors.assign(question.sectors.begin() + static_cast<std::ptrdiff_t>(first),
                            question.sectors.begin() + static_cast<std::ptrdiff_t>(end));
        auto answer = executor_.assess(std::move(part)).get();
        if (!answer)
            return answer;
        all.sectors.insert(all.sectors.end(), answer->sectors.begin(), answer->sectors.end());
        all.warnings.insert(all.warnings.end(), answer->warnings.begin(), answer->warnings.end());
        for (worker::MapChange& change : answer->changes) {
            if (std::ranges::find(all.changes, change) == all.changes.end())
                all.changes.push_back(std::move(change));
        }
    }
    return all;
}

double seconds_to_bake(const Plan& plan, int threads) {
    double seconds = 0;
    for (const PlannedSector& sector : plan.sectors) {
        if (sector.verdict == reuse::Verdict::rebake)
            seconds += sector.seconds;
    }
    const std::int64_t at_once = std::clamp<std::int64_t>(plan.count(reuse::Verdict::rebake), 1, threads);
    return seconds / static_cast<double>(at_once);
}

}  // namespace drtv::farm
