#include "bakerd/farm/assess_results.h"

#include "bakerd/bake/sector_file.h"
#include "bakerd/reuse/assessment.h"
#include "bakerd/reuse/describe.h"
#include "bakerd/reuse/footprint_record.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <set>

namespace drtv::farm {
namespace {

constexpr std::size_t most_changes = 1000, most_warnings = 20;

// Of a sector; nothing, with a sentence, when it cannot be read.
std::optional<reuse::Footprint> read_footprint(const Digest& digest,
                                               const map::SectorCoordinate& sector,
                                               BlobStore& store,
                                               std::string& problem) {
    const auto bytes = store.get(digest);
    auto footprint = bytes ? reuse::decode_footprint(*bytes) : std::nullopt;
    if (footprint && footprint->sector == sector)
        return footprint;
    problem = fmt::format("sector ({}, {}): the record of an earlier result cannot be used: {}",
                          sector.i,
                          sector.j,
                          bytes ? "it is not one" : bytes.error().message);
    return std::nullopt;
}

class Assessing {
  public:
    Assessing(const AssessRequest& request, bake::World& world, ChangesSince& changes, BlobStore& store)
        : request_(request), world_(world), changes_(changes), store_(store) {}

    AssessAnswer run() {
        AssessAnswer answer;
        answer.sectors.resize(request_.sectors.size());
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(std::size_t{0}, request_.sectors.size(), [&](std::size_t n) {
                const trace::FloatMode float_mode;
                answer.sectors[n] = assess(request_.sectors[n]);
            });
        });
        tell_changes(answer);
        answer.warnings.assign(warnings_.begin(), warnings_.end());
        return answer;
    }

  private:
    AssessAnswer::Sector assess(const AssessRequest::Sector& sector) {
        AssessAnswer::Sector best;
        best.reason = "its earlier results are lost";
        bool first = true;
        for (std::size_t c = 0; c < sector.candidates.size(); ++c) {
            std::string problem;
            const auto changes = changes_.map(sector.candidates[c].inventory, problem);
            const auto footprint =
                changes ? read_footprint(sector.candidates[c].footprint, sector.sector, store_, problem)
                        : std::nullopt;
            if (!footprint) {
                warn(problem);
                continue;
            }
            const float tolerance = request_.settings.tolerance;
            const reuse::Assessment assessment =
                reuse::assess(*footprint, request_.settings, *changes, tolerance, world_);
            if (assessment.verdict == reuse::Verdict::hit)
                return {assessment.verdict, c, 0, 0, ""};
            const bool near = assessment.verdict == reuse::Verdict::near_hit;
            const float share = near ? 0 : reuse::share_to_bake(assessment);
            if (first || share < best.share || (near && assessment.bound < best.bound))
                best = {
                    assessment.verdict, c, assessment.bound, share, reuse::describe(assessment, *changes)};
            first = false;
        }
        return best;
    }

    // Since the maps of those results that are not the same any more, each once.
    void tell_changes(AssessAnswer& answer) {
        std::set<Digest> inventories;
        for (std::size_t n = 0; n < answer.sectors.size(); ++n) {
            if (answer.sectors[n].verdict != reuse::Verdict::hit && !request_.sectors[n].candidates.empty())
                inventories.insert(request_.sectors[n].candidates[answer.sectors[n].candidate].inventory);
        }
        std::set<std::pair<std::string, std::array<float, 6>>> told;
        for (const Digest& inventory : inventories) {
            std::string problem;
            const auto changes = changes_.map(inventory, problem);
            if (!changes)
                continue;
            for (const reuse::Change& change : *changes) {
                map::Bounds bounds;
                for (const auto* item : {&change.before, &change.after}) {
                    if (!*item || (*item)->bounds.empty())
                        continue;
                    bounds.extend((*item)->bounds.low);
                    bounds.extend((*item)->bounds.high);
                }
                if (bounds.empty() || answer.changes.size() >= most_changes)
                    continue;
                const std::string what = reuse::describe(change);
                if (told.insert({what,
                                 {bounds.low.x,
                                  bounds.low.y,
                                  bounds.low.z,
                                  bounds.high.x,
                                  bounds.high.y,
                                  bounds.high.z}})
                        .second)
                    answer.changes.push_back({what, bounds});
            }
        }
    }

    void warn(const std::string& sentence) {
        const std::lock_guard lock(mutex_);
        if (warnings_.size() < most_warnings)
            warnings_.insert(sentence);
    }

    const AssessRequest& request_;
    bake::World& world_;
    ChangesSince& changes_;
    BlobStore& store_;
    std::mutex mutex_;
    std::set<std::string> warnings_;  // guarded by mutex_
};

}  // namespace

std::shared_ptr<const std::vector<reuse::Change>> ChangesSince::map(const Digest& inventory,
                                                                    std::string& problem) {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(inventory); found != known_.end())
        return found->second;
    const auto bytes = store_.get(inventory);
    const auto before = bytes ? reuse::decode_inventory(*bytes) : std::nullopt;
    if (before)
        return known_[inventory] = std::make_shared<const std::vector<reuse::Change>>(
                   reuse::changes_between(*before, *inventory_));
    problem = fmt::format("the record of an earlier map cannot be used: {}",
                          bytes ? "it is not one" : bytes.error().message);
    return nullptr;
}

AssessAnswer assess_results(const AssessRequest& request,
                            bake::World& world,
                            ChangesSince& changes,
                            BlobStore& store) {
    return Assessing(request, world, changes, store).run();
}

std::optional<reuse::EarlierBake> read_earlier(const BakeRequest& request,
                                               bake::World& world,
                                               ChangesSince& changes,
                                               BlobStore& store) {
    if (!request.earlier)
        return std::nullopt;
    std::string problem;
    const auto since = changes.map(request.earlier->inventory, problem);
    const auto file = store.get(request.earlier->file);
    auto footprint = read_footprint(request.earlier->footprint, request.sector, store, problem);
    auto sector = file ? bake::decode_sector(*file) : std::nullopt;
    if (!since || !footprint || !sector)
        return std::nullopt;
    reuse::EarlierBake earlier{std::move(*sector), std::move(*footprint), {}};
    earlier.assessment =
        reuse::assess(earlier.footprint, request.settings, *since, request.settings.tolerance, world);
    return earlier;
}

}  // namespace drtv::farm
