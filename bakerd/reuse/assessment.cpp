#include "bakerd/reuse/assessment.h"

#include "bakerd/reuse/boxes.h"
#include "bakerd/reuse/crossed_blocks.h"
#include "bakerd/reuse/first_rays.h"
#include "bakerd/reuse/placement_changes.h"
#include "bakerd/reuse/static_gain.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace drtv::reuse {
namespace {

bool is_object(const Item& item) {
    return item.kind == ItemKind::fixed || item.kind == ItemKind::vegetation;
}

// Where a thing is and was.
std::vector<const Item*> sides_of(const Change& change) {
    std::vector<const Item*> sides;
    for (const std::optional<Item>* item : {&change.before, &change.after}) {
        if (*item)
            sides.push_back(&**item);
    }
    return sides;
}

class Assessor {
  public:
    Assessor(const Footprint& footprint, const settings::JobSettings& settings, bake::World& world)
        : footprint_(footprint),
          settings_(settings.bake),
          world_(world),
          crossed_blocks_(footprint),
          solid_tests_(footprint),
          placement_reach_(placement_reach(footprint, settings.bake, world)) {
        assessment_.tolerance = footprint.without_bounds ? 0 : settings.tolerance;
    }

    Assessment run(std::span<const Change> changes) {
        set_gain(changes);
        for (const ProbeRecord& probe : footprint_.probes)
            assessment_.probe_bounds.push_back(probe.changed_weight * assessment_.gain);
        for (std::size_t n = 0; n < changes.size() && !settled(); ++n) {
            const auto [bound, cause] = bound_of(changes[n]);
            if (!(bound > 0) || (assessment_.change && bound <= assessment_.change_bound))
                continue;
            assessment_.change = n;
            assessment_.cause = cause;
            assessment_.change_bound = bound;
        }
        for (const float bound : assessment_.probe_bounds)
            assessment_.bound = std::max(assessment_.bound, bound);
        if (!assessment_.placement_holds)
            assessment_.bound = unbounded;
        assessment_.verdict = verdict();
        assessment_.flips = solid_tests_.counts();
        if (only_as_a_whole())
            assessment_.probe_bounds.clear();
        return std::move(assessment_);
    }

  private:
    struct ChangeBound {
        float bound = 0;
        Cause cause = Cause::rays;
    };

    // One for all changes: a path that one lets through may find what another has put beside a lamp.
    void set_gain(std::span<const Change> changes) {
        std::vector<Bounds> boxes;
        for (const Change& change : changes)
            std::ranges::copy(boxes_of(change), std::back_inserter(boxes));
        std::erase_if(boxes, [&](const Bounds& box) { return !within_reach({&box, 1}); });
        const float before = footprint_.max_scattered;
        const float now = std::max(before, world_.max_scattered());
        assessment_.static_gain = raised_gain(footprint_.static_gain, before, now, settings_) +
                                  static_gain(world_.lights(), now, boxes, settings_);
        assessment_.gain = std::max(1.0f, assessment_.static_gain);
    }

    [[nodiscard]] Verdict verdict() const {
        if (over(assessment_.bound))
            return Verdict::rebake;
        return assessment_.bound > 0 ? Verdict::near_hit : Verdict::hit;
    }

    // Local transfer is of all probes together, and a number of rays that follows from what they find is
    // in no record. Of a scene with other heights the record cannot go on.
    [[nodiscard]] bool only_as_a_whole() {
        if (footprint_.without_bounds)
            return true;
        if (assessment_.verdict != Verdict::rebake || settled())
            return false;
        return footprint_grid(footprint_.sector, settings_, world_) != footprint_.grid;
    }

    [[nodiscard]] bool over(float bound) const { return bound > assessment_.tolerance; }

    // Nothing can be taken over.
    [[nodiscard]] bool settled() const {
        return !assessment_.placement_holds &&
               std::ranges::all_of(assessment_.probe_bounds, [&](float bound) { return over(bound); });
    }

    // Counts the change in.
    ChangeBound bound_of(const Change& change) {
        ChangeBound largest;
        const auto count = [&](Cause cause, float bound) {
            if (bound > largest.bound)
                largest = {bound, cause};
        };
        const auto placement_fails = [&](Cause cause) {
            assessment_.placement_holds = false;
            count(cause, unbounded);
        };
        ProbesMove move = ProbesMove::no;
        for (const Item* item : sides_of(change)) {
            move = std::max(move, moves_probes(*item, footprint_, placement_reach_));
            if (shines_on_probes(*item))
                count(Cause::light, unbounded);
        }
        const std::vector<Bounds> boxes = boxes_of(change);
        if (assessment_.placement_holds && solid_tests_.add(boxes))
            move = std::max(move, ProbesMove::maybe);
        if (move == ProbesMove::yes || (move == ProbesMove::maybe && stand_elsewhere()))
            placement_fails(change.item().kind == ItemKind::interior ? Cause::interior : Cause::placement);
        if (within_reach(boxes))
            count(Cause::rays, count_rays(boxes));
        return largest;
    }

    // Where geometry was and is.
    [[nodiscard]] std::vector<Bounds> boxes_of(const Change& change) const {
        std::vector<Bounds> boxes;
        for (const Item* item : sides_of(change)) {
            if (is_object(*item))
                boxes.push_back(grown(item->bounds, glm::vec3(slack_m(item->bounds, footprint_.reach_m))));
        }
        return boxes;
    }

    // Gives the most that the boxes change of any probe.
    float count_rays(std::span<const Bounds> boxes) {
        const float gain = assessment_.gain;
        const std::array<float, quarter_count> later = crossed_blocks_.add(boxes);
        float most = 0;
        for (std::size_t p = 0; p < footprint_.probes.size(); ++p) {
            float& bound = assessment_.probe_bounds[p];
            float more = later[quarter_of(footprint_.sector, footprint_.probes[p].position)] * gain;
            // No need to look for more than what settles it.
            if (!over(bound + more))
                more += first_rays().weight_of(p, boxes) * gain;
            bound += more;
            most = std::max(most, more);
        }
        return most;
    }

    // Lights within reach are in a probe's tree, seen or not. Whether it is one of any probe's.
    bool shines_on_probes(const Item& item) {
        const bool everywhere = item.kind == ItemKind::sun;
        const bool emissive = item.emissive && is_object(item);
        if (!emissive && !everywhere && item.kind != ItemKind::lamp)
            return false;
        const glm::vec3 centre = (item.bounds.low + item.bounds.high) * 0.5f;
        // The emissive part, which is what counts, may lie at one end and be as large as the whole.
        const float diagonal_m = glm::length(item.bounds.high - item.bounds.low);
        const float reach_m = footprint_.reach_m + diagonal_m + 2 * slack_m(item.bounds, footprint_.reach_m);
        bool any = false;
        for (std::size_t p = 0; p < footprint_.probes.size(); ++p) {
            const glm::vec3 place = placement::metres(footprint_.probes[p].position);
            if (!everywhere && glm::distance(place, centre) > reach_m)
                continue;
            assessment_.probe_bounds[p] = std::max(assessment_.probe_bounds[p], unbounded);
            any = true;
        }
        return any;
    }

    // Whether placing the sector again gives anything else.
    bool stand_elsewhere() {
        if (!assessment_.placed_again) {
            assessment_.placed_again = true;
            stands_elsewhere_ =
                placement_digest(world_, footprint_.sector, settings_) != footprint_.placement;
        }
        return stands_elsewhere_;
    }

    [[nodiscard]] bool within_reach(std::span<const Bounds> boxes) const {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        Bounds reached{footprint_.grid.low(), footprint_.grid.high()};
        reached.low.z = -infinity;
        reached.high.z = infinity;
        return !footprint_.probes.empty() &&
               std::ranges::any_of(boxes, [&](const Bounds& box) { return overlap(box, reached); });
    }

    // Made when first needed, as are the first rays: most results are asked about things far away.
    const bake::Surroundings& around() {
        if (!around_)
            around_ = world_.surroundings(footprint_.sector, settings_);
        return *around_;
    }

    const FirstRays& first_rays() {
        if (!first_rays_)
            first_rays_.emplace(footprint_, *around().samples, *around().scene);
        return *first_rays_;
    }

    const Footprint& footprint_;
    const settings::BakeSettings& settings_;
    bake::World& world_;
    CrossedBlocks crossed_blocks_;
    SolidTestChanges solid_tests_;
    const PlacementReach placement_reach_;
    bool stands_elsewhere_ = false;
    Assessment assessment_;
    std::optional<bake::Surroundings> around_;
    std::optional<FirstRays> first_rays_;
};

}  // namespace

Assessment assess(const Footprint& footprint,
                  const settings::JobSettings& settings,
                  std::span<const Change> changes,
                  bake::World& world) {
    return Assessor(footprint, settings, world).run(changes);
}

float share_to_bake(const Assessment& assessment) {
    if (assessment.probe_bounds.empty())
        return 1;
    const auto over = std::ranges::count_if(assessment.probe_bounds,
                                            [&](float bound) { return bound > assessment.tolerance; });
    return static_cast<float>(over) / static_cast<float>(assessment.probe_bounds.size());
}

}  // namespace drtv::reuse
