#include "bakerd/worker/assess_results.h"

#include "bakerd/bake/sector_file.h"
#include "bakerd/reuse/assessment.h"
#include "bakerd/reuse/describe.h"
#include "bakerd/reuse/footprint_record.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <tuple>

namespace drtv::worker {
namespace {

constexpr std::size_t max_changes = 1000;

tl::expected<reuse::Footprint, std::string> read_footprint(const Digest& digest,
                                                           map::SectorCoordinate sector,
                                                           store::BlobStore& store) {
    const auto bytes = store.get(digest);
    auto footprint = bytes ? reuse::decode_footprint(*bytes) : std::nullopt;
    if (footprint && footprint->sector == sector)
        return std::move(*footprint);
    return tl::unexpected(fmt::format("sector ({}, {}): the record of an earlier result cannot be used: {}",
                                      sector.i,
                                      sector.j,
                                      bytes ? "it is not one" : bytes.error().message));
}

// Where the thing was and is; nothing where it stands nowhere.
map::Bounds bounds_of(const reuse::Change& change) {
    map::Bounds bounds;
    for (const auto* item : {&change.before, &change.after}) {
        if (!*item || (*item)->bounds.empty())
            continue;
        bounds.extend((*item)->bounds.low);
        bounds.extend((*item)->bounds.high);
    }
    return bounds;
}

class Assessing {
  public:
    Assessing(const AssessRequest& request, const LoadedMap& map, store::BlobStore& store)
        : request_(request), map_(map), store_(store) {}

    Assessments run() {
        Assessments answer;
        answer.sectors.resize(request_.sectors.size());
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(std::size_t{0}, request_.sectors.size(), [&](std::size_t n) {
                const trace::FloatMode float_mode;
                answer.sectors[n] = assess(request_.sectors[n]);
            });
        });
        add_changes(answer);
        answer.warnings.assign(warnings_.begin(), warnings_.end());
        return answer;
    }

  private:
    Assessments::Sector assess(const AssessRequest::Sector& sector) {
        Assessments::Sector best;
        best.reason = best.cause = "its earlier results are lost";
        bool first = true;
        for (std::size_t c = 0; c < sector.candidates.size(); ++c) {
            const auto changes = map_.changes->map(sector.candidates[c].inventory);
            if (!changes) {
                warn(changes.error());
                continue;
            }
            const auto footprint = read_footprint(sector.candidates[c].footprint, sector.sector, store_);
            if (!footprint) {
                warn(footprint.error());
                continue;
            }
            const reuse::Assessment assessment =
                reuse::assess(*footprint, request_.settings, **changes, *map_.world);
            if (assessment.verdict == reuse::Verdict::hit)
                return {assessment.verdict, c, 0, 0, "", ""};
            const bool near = assessment.verdict == reuse::Verdict::near_hit;
            const float share = near ? 0 : reuse::share_to_bake(assessment);
            if (first || share < best.share || (near && assessment.bound < best.bound)) {
                best = {assessment.verdict,
                        c,
                        assessment.bound,
                        share,
                        reuse::describe(assessment, **changes),
                        reuse::describe_cause(assessment, **changes)};
            }
            first = false;
        }
        return best;
    }

    // Since the maps of those results that are not the same any more, each once.
    void add_changes(Assessments& answer) {
        std::set<Digest> inventories;
        for (std::size_t n = 0; n < answer.sectors.size(); ++n) {
            const auto& candidates = request_.sectors[n].candidates;
            if (answer.sectors[n].verdict != reuse::Verdict::hit && !candidates.empty())
                inventories.insert(candidates[answer.sectors[n].candidate].inventory);
        }
        using Place = std::tuple<float, float, float, float, float, float>;
        std::set<std::pair<std::string, Place>> known;
        for (const Digest& inventory : inventories) {
            const auto changes = map_.changes->map(inventory);
            if (!changes)
                continue;
            for (const reuse::Change& change : **changes) {
                const map::Bounds bounds = bounds_of(change);
                if (bounds.empty() || answer.changes.size() >= max_changes)
                    continue;
                const auto& [low, high] = bounds;
                const std::string what = reuse::describe(change);
                if (known.insert({what, {low.x, low.y, low.z, high.x, high.y, high.z}}).second)
                    answer.changes.push_back({what, bounds});
            }
        }
    }

    void warn(const std::string& sentence) {
        const std::lock_guard lock(mutex_);
        if (warnings_.size() < max_warnings)
            warnings_.insert(sentence);
    }

    const AssessRequest& request_;
    const LoadedMap& map_;
    store::BlobStore& store_;
    std::mutex mutex_;
    std::set<std::string> warnings_;  // guarded by mutex_
};

}  // namespace

Assessments assess_results(const AssessRequest& request, const LoadedMap& map, store::BlobStore& store) {
    return Assessing(request, map, store).run();
}

tl::expected<reuse::EarlierBake, std::string> read_earlier(const ResultBlobs& earlier,
                                                           map::SectorCoordinate sector,
                                                           const settings::JobSettings& settings,
                                                           const LoadedMap& map,
                                                           store::BlobStore& store) {
    const auto changes = map.changes->map(earlier.inventory);
    if (!changes)
        return tl::unexpected(changes.error());
    auto footprint = read_footprint(earlier.footprint, sector, store);
    if (!footprint)
        return tl::unexpected(footprint.error());
    const auto bytes = store.get(earlier.file);
    if (!bytes)
        return tl::unexpected(bytes.error().message);
    auto file = bake::decode_sector(*bytes);
    if (!file)
        return tl::unexpected(
            fmt::format("sector ({}, {}): the file of an earlier result is not one", sector.i, sector.j));
    reuse::EarlierBake read{std::move(*file), std::move(*footprint), {}};
    read.assessment = reuse::assess(read.footprint, settings, **changes, *map.world);
    return read;
}

}  // namespace drtv::worker
