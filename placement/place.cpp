// The decisions. Manual probes stand; then proposals in the order of their priority, each kept if it sees no
// kept one nearer than the minimal distance; last, those that stood in a solid and found a free place nearby.
// A moved probe yields to any moved one of higher priority that it sees near it, kept or not: so no chain of
// decisions runs far.
#include "placement/placement.h"

#include "placement/candidates.h"
#include "placement/manual.h"
#include "placement/plan_index.h"
#include "placement/solid_test.h"
#include "placement/thinning.h"
#include "placement/units.h"
#include "placement/way_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drtv::placement {
namespace {

constexpr std::int32_t sector_side = sector_size_m * units_per_m;

class Placer {
  public:
    Placer(const Input& input, const SceneQueries& queries, const PlacementSettings& settings)
        : input_(input), queries_(queries), settings_(settings), manual_(manual_probes(input.manual)) {
        for (std::size_t n = 0; n < manual_.size(); ++n)
            manual_index_.add(manual_[n].position, n);
    }

    tl::expected<Placement, std::string> run() {
        for (const Manual& probe : manual_) {
            if (in_sector(probe.position))
                placement_.probes.push_back({probe.position, Kind::manual});
        }
        const std::size_t manual_count = placement_.probes.size();
        if (manual_count > max_probes) {
            return tl::unexpected(fmt::format("sector ({}, {}) holds {} manual probes, over the limit of {}",
                                              input_.i,
                                              input_.j,
                                              manual_count,
                                              max_probes));
        }
        for (const PlacedProbe& probe : placement_.probes) {
            const StandsAt at = stands(probe.position);
            if (at.stand != Stand::free)
                placement_.buried_manual.push_back({probe.position, at.stand, at.thing});
        }
        decide();
        std::vector<PlacedProbe> automatic = thinned(manual_count);
        std::ranges::sort(automatic, is_before, &PlacedProbe::position);
        placement_.probes.insert(placement_.probes.end(), automatic.begin(), automatic.end());
        return std::move(placement_);
    }

  private:
    [[nodiscard]] bool in_sector(const Position& p) const {
        const std::int64_t x = std::int64_t{p.x} - std::int64_t{input_.i} * sector_side;
        const std::int64_t y = std::int64_t{p.y} - std::int64_t{input_.j} * sector_side;
        return x >= 0 && x < sector_side && y >= 0 && y < sector_side;
    }

    [[nodiscard]] StandsAt stands(const Position& position) {
        const StandsAt at = stands_at(position, queries_);
        placement_.solid_tests.push_back({position, at.to_flip});
        return at;
    }

    [[nodiscard]] bool in_volume(const Position& position) const {
        const glm::dvec3 point(metres(position));
        const auto holds_it = [&](const ClosedVolume& volume) { return volume.contains(point); };
        return std::ranges::any_of(input_.no_probes, holds_it);
    }

    [[nodiscard]] bool sees(const Position& a, const Position& b) const {
        return !queries_.separated(metres(a), metres(b));
    }

    // Whether a probe takes the place of another.
    [[nodiscard]] bool is_near(const Position& a, const Position& b, float distance_m) const {
        return squared_distance(a, b) < squared_units(distance_m) && sees(a, b);
    }

    [[nodiscard]] bool near_manual(const Position& position, float distance_m) const {
        return manual_index_.any_near(position, distance_m, [&](std::size_t n) {
            return is_near(position, manual_[n].position, distance_m) && serves(manual_[n], position);
        });
    }

    [[nodiscard]] bool near_kept(const Position& position, float distance_m) const {
        return near_manual(position, distance_m) ||
               kept_index_.any_near(position, distance_m, [&](std::size_t n) {
                   const Candidate& other = kept_[n];
                   return is_near(position, other.position, std::min(distance_m, other.min_distance_m));
               });
    }

    void keep(const Candidate& candidate) {
        kept_index_.add(candidate.position, kept_.size());
        kept_.push_back(candidate);
    }

    // The nearest free place within half the distance, in the same sector.
    [[nodiscard]] std::optional<Position> free_place(const Candidate& from, Stand stand) {
        for (const float share : {0.125f, 0.25f, 0.5f}) {
            const float way_units = share * from.min_distance_m * static_cast<float>(units_per_m);
            for (const glm::vec3& way : ways_out()) {
                // Truncated towards zero, so that the way stays within half the distance.
                const Position place = from.position + Position(way * way_units);
                if (sector_of(place.x) != sector_of(from.position.x) ||
                    sector_of(place.y) != sector_of(from.position.y) || in_volume(place))
                    continue;
                if (leads_out(from.position, place, stand, queries_) && stands(place).stand == Stand::free)
                    return place;
            }
        }
        return std::nullopt;
    }

    struct Buried {
        Candidate candidate;
        StandsAt at;
    };

    void decide() {
        const double margin_m = double{decision_margin_m(settings_, input_.spacings)};
        const glm::dvec2 corner(input_.i * sector_size_m, input_.j * sector_size_m);
        std::vector<Buried> buried;
        const Square square{corner - margin_m, corner + double{sector_size_m} + margin_m};
        PlacementReport& report = placement_.report;
        for (const Candidate& candidate : propose(square, input_, queries_, settings_)) {
            const bool ours = in_sector(candidate.position);
            report.candidates += ours ? 1 : 0;
            if (in_volume(candidate.position)) {
                report.removed_by_volume += ours ? 1 : 0;
                continue;
            }
            if (near_kept(candidate.position, candidate.min_distance_m))
                continue;
            const StandsAt at = stands(candidate.position);
            if (at.stand == Stand::free)
                keep(candidate);
            else
                buried.push_back({candidate, at});
        }
        move_out(buried);
    }

    void move_out(const std::vector<Buried>& buried) {
        std::vector<Candidate> higher;
        PlanIndex higher_index;
        std::vector<Candidate> moved;
        PlacementReport& report = placement_.report;
        for (const auto& [candidate, at] : buried) {
            const bool ours = in_sector(candidate.position);
            const std::optional<Position> place = free_place(candidate, at.stand);
            if (!place) {
                if (ours) {
                    ++report.dropped_in_solid;
                    placement_.dropped_in.push_back(at.thing);
                }
                continue;
            }
            Candidate at_place = candidate;
            at_place.position = *place;
            at_place.moved = true;
            const auto takes_its_place = [&](std::size_t n) {
                return is_near(
                    *place, higher[n].position, std::min(candidate.min_distance_m, higher[n].min_distance_m));
            };
            const bool yields = higher_index.any_near(*place, candidate.min_distance_m, takes_its_place);
            higher_index.add(*place, higher.size());
            higher.push_back(at_place);
            if (yields || near_kept(*place, candidate.min_distance_m))
                continue;
            report.moved_out += ours ? 1 : 0;
            moved.push_back(at_place);
        }
        for (const Candidate& candidate : moved)
            keep(candidate);
    }

    // This sector's own probes, no more than find room beside the manual ones.
    std::vector<PlacedProbe> thinned(std::size_t manual_count) {
        std::vector<Candidate> own;
        const auto is_ours = [&](const Candidate& candidate) { return in_sector(candidate.position); };
        std::ranges::copy_if(kept_, std::back_inserter(own), is_ours);
        Thinned left = thin(
            own, max_probes - manual_count, [&](const Position& a, const Position& b) { return sees(a, b); });
        PlacementReport& report = placement_.report;
        report.used_distance_m = settings_.min_distance_m * left.growth;
        report.thinned = static_cast<std::uint32_t>(own.size() - left.probes.size());
        return std::move(left.probes);
    }

    const Input& input_;
    const SceneQueries& queries_;
    const PlacementSettings& settings_;
    const std::vector<Manual> manual_;  // of the whole map
    PlanIndex manual_index_;
    std::vector<Candidate> kept_;  // by priority, the moved ones last
    PlanIndex kept_index_;
    Placement placement_;
};

}  // namespace

float decision_margin_m(const PlacementSettings& settings, std::span<const SpacingVolume> spacings) {
    // A decision waits for those of higher classes, one step of at most the distance each: the ground's and
    // the vegetation's classes of each distance, then the moved ones, which also went up to half the
    // distance.
    float margin_m = 0;
    float max_m = 0;
    for (const float distance_m : distances_kept(settings, spacings)) {
        for (const Kind kind : {Kind::ground, Kind::vegetation}) {
            const std::uint32_t stride = lattice_stride(lattice_side_m(kind, distance_m), distance_m);
            margin_m += distance_m * static_cast<float>(stride * stride);
        }
        max_m = std::max(max_m, distance_m);
    }
    return margin_m + 2 * max_m;
}

tl::expected<Placement, std::string> place_probes(const Input& input,
                                                  const SceneQueries& queries,
                                                  const PlacementSettings& settings) {
    return Placer(input, queries, settings).run();
}

}  // namespace drtv::placement
