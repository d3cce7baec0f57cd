#include "bakerd/farm/assess_results.h"

#include "bakerd/bake/assessment.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

namespace drtv::farm {
namespace {

constexpr std::size_t most_changes = 1000, most_warnings = 20;

using Changes = std::shared_ptr<const std::vector<bake::Change>>;

class Assessing {
  public:
    Assessing(const AssessRequest& request, bake::World& world, const bake::Inventory& inventory, BlobStore& store) : request_(request), world_(world), inventory_(inventory), store_(store) {}

    AssessAnswer run() {
        AssessAnswer answer;
        answer.sectors.resize(request_.sectors.size());
        // Each map of which there are results, before the sectors: so no two threads read the same.
        for (const AssessRequest::Sector& sector : request_.sectors) {
            for (const AssessRequest::Candidate& candidate : sector.candidates) {
                if (!changes_.contains(candidate.inventory)) changes_[candidate.inventory] = changes_since(candidate.inventory);
            }
        }
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
    Changes changes_since(const Digest& digest) {
        const auto bytes = store_.get(digest);
        const auto before = bytes ? bake::decode_inventory(*bytes) : std::nullopt;
        if (before) return std::make_shared<const std::vector<bake::Change>>(bake::changes_between(*before, inventory_));
        warn(fmt::format("the record of an earlier map cannot be used: {}", bytes ? "it is not one" : bytes.error().message));
        return nullptr;
    }

    AssessAnswer::Sector assess(const AssessRequest::Sector& sector) {
        AssessAnswer::Sector best;
        best.reason = "its earlier results are lost";
        bool first = true;
        for (std::size_t c = 0; c < sector.candidates.size(); ++c) {
            const Changes& changes = changes_.at(sector.candidates[c].inventory);
            if (!changes) continue;
            const auto bytes = store_.get(sector.candidates[c].footprint);
            const auto footprint = bytes ? bake::decode_footprint(*bytes) : std::nullopt;
            if (!footprint || footprint->sector != sector.sector) {
                warn(fmt::format("sector ({}, {}): the record of an earlier result cannot be used: {}", sector.sector.i, sector.sector.j, bytes ? "it is not one" : bytes.error().message));
                continue;
            }
            const bake::Assessment assessment = bake::assess(*footprint, request_.settings, *changes, request_.settings.tolerance, world_);
            if (assessment.verdict == bake::Verdict::hit) return {assessment.verdict, c, 0, ""};
            const bool nearer = assessment.verdict == bake::Verdict::near_hit && (best.verdict == bake::Verdict::rebake || assessment.bound < best.bound);
            if (nearer || (first && best.verdict == bake::Verdict::rebake)) best = {assessment.verdict, c, assessment.bound, bake::describe(assessment, *changes)};
            first = false;
        }
        return best;
    }

    // Since the maps of those results that are not the same any more, each once.
    void tell_changes(AssessAnswer& answer) const {
        std::set<Digest> inventories;
        for (std::size_t n = 0; n < answer.sectors.size(); ++n) {
            if (answer.sectors[n].verdict != bake::Verdict::hit && !request_.sectors[n].candidates.empty()) inventories.insert(request_.sectors[n].candidates[answer.sectors[n].candidate].inventory);
        }
        std::set<std::pair<std::string, std::array<float, 6>>> told;
        for (const Digest& inventory : inventories) {
            const Changes& changes = changes_.at(inventory);
            if (!changes) continue;
            for (const bake::Change& change : *changes) {
                map::Bounds bounds;
                for (const auto* item : {&change.before, &change.after}) {
                    if (!*item || (*item)->bounds.empty()) continue;
                    bounds.extend((*item)->bounds.low);
                    bounds.extend((*item)->bounds.high);
                }
                if (bounds.empty() || answer.changes.size() >= most_changes) continue;
                const std::string what = bake::describe(change);
                if (told.insert({what, {bounds.low.x, bounds.low.y, bounds.low.z, bounds.high.x, bounds.high.y, bounds.high.z}}).second) answer.changes.push_back({what, bounds});
            }
        }
    }

    void warn(const std::string& sentence) {
        const std::lock_guard lock(mutex_);
        if (warnings_.size() < most_warnings) warnings_.insert(sentence);
    }

    const AssessRequest& request_;
    bake::World& world_;
    const bake::Inventory& inventory_;
    BlobStore& store_;
    std::map<Digest, Changes> changes_;  // by inventory; nothing where that cannot be read
    std::mutex mutex_;
    std::set<std::string> warnings_;  // guarded by mutex_
};

}  // namespace

AssessAnswer assess_results(const AssessRequest& request, bake::World& world, const bake::Inventory& inventory, BlobStore& store) { return Assessing(request, world, inventory, store).run(); }

}  // namespace drtv::farm
