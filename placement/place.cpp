// The decisions. Manual probes stand; then proposals in the order of their priority, each kept if no kept one
// is nearer than the minimal distance; last, those that stood in a solid and found a free place nearby. A
// moved probe yields to any moved one of higher priority near it, kept or not: so no chain of decisions runs
// far.
#include "placement/placement.h"

#include "placement/candidates.h"
#include "placement/thinning.h"
#include "placement/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace drtv::placement {
namespace {

constexpr std::int32_t sector_side = sector_size_m * units_per_m;

// An order that no change elsewhere in a sector disturbs much.
bool is_before(const Position& a, const Position& b) {
    return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
}

// The manual probes of the whole map, each once.
std::vector<Position> manual_positions(std::span<const glm::dvec3> manual) {
    std::vector<Position> positions;
    for (const glm::dvec3& m : manual)
        positions.emplace_back(to_units(m.x), to_units(m.y), to_units(m.z));
    std::ranges::sort(positions, is_before);
    const auto repeated = std::ranges::unique(positions);
    positions.erase(repeated.begin(), repeated.end());
    return positions;
}

class Placer {
  public:
    Placer(const Input& input, const Surroundings& surroundings, const Settings& settings)
        : input_(input),
          surroundings_(surroundings),
          settings_(settings),
          min_squared_(squared_units(settings.min_distance_m)),
          manual_(manual_positions(input.manual)) {}

    tl::expected<Placement, std::string> run() {
        Placement placement;
        for (const Position& position : manual_) {
            if (in_sector(position))
                placement.probes.push_back({position, Kind::manual});
        }
        if (placement.probes.size() > max_probes) {
            return tl::unexpected(fmt::format("sector ({}, {}) holds {} manual probes, over the limit of {}",
                                              input_.i,
                                              input_.j,
                                              placement.probes.size(),
                                              max_probes));
        }
        decide();
        std::vector<PlacedProbe> automatic = thinned(placement.probes.size());
        std::ranges::sort(automatic, is_before, &PlacedProbe::position);
        placement.probes.insert(placement.probes.end(), automatic.begin(), automatic.end());
        placement.report = report_;
        return placement;
    }

  private:
    [[nodiscard]] bool in_sector(const Position& p) const {
        const std::int64_t x = std::int64_t{p.x} - std::int64_t{input_.i} * sector_side;
        const std::int64_t y = std::int64_t{p.y} - std::int64_t{input_.j} * sector_side;
        return x >= 0 && x < sector_side && y >= 0 && y < sector_side;
    }

    [[nodiscard]] bool in_solid(const Position& position) const {
        const std::size_t backs = surroundings_.backs_met(metres(position), solid_test_directions());
        return is_in_solid(backs);
    }

    [[nodiscard]] bool in_volume(const Position& position) const {
        const glm::dvec3 point(metres(position));
        const auto holds_it = [&](const ClosedVolume& volume) { return volume.contains(point); };
        return std::ranges::any_of(input_.no_probes, holds_it);
    }

    [[nodiscard]] bool is_near(const Position& a, const Position& b) const {
        return squared_distance(a, b) < min_squared_;
    }

    [[nodiscard]] bool near_kept(const Position& position) const {
        const auto near_position = [&](const Position& other) { return is_near(position, other); };
        return std::ranges::any_of(manual_, near_position) ||
               std::ranges::any_of(kept_, near_position, &Candidate::position);
    }

    // The nearest free place within half the spacing, in the same sector.
    [[nodiscard]] std::optional<Position> free_place(const Position& from) const {
        for (float share : {0.125f, 0.25f, 0.5f}) {
            const float way_units = share * settings_.min_distance_m * static_cast<float>(units_per_m);
            for (const glm::vec3& direction : solid_test_directions()) {
                // Truncated towards zero, so that the way stays within half the spacing.
                const Position place = from + Position(direction * way_units);
                if (sector_of(place.x) != sector_of(from.x) || sector_of(place.y) != sector_of(from.y))
                    continue;
                if (!in_volume(place) && !in_solid(place))
                    return place;
            }
        }
        return std::nullopt;
    }

    void decide() {
        const double margin_m = decision_margin_m(settings_);
        const glm::dvec2 corner(input_.i * sector_size_m, input_.j * sector_size_m);
        std::vector<Candidate> buried;
        const Square square{corner - margin_m, corner + double{sector_size_m} + margin_m};
        for (const Candidate& candidate : propose(square, input_.vegetation, surroundings_, settings_)) {
            const bool ours = in_sector(candidate.position);
            if (ours)
                ++report_.candidates;
            if (in_volume(candidate.position)) {
                if (ours)
                    ++report_.removed_by_volume;
                continue;
            }
            if (near_kept(candidate.position))
                continue;
            if (in_solid(candidate.position))
                buried.push_back(candidate);
            else
                kept_.push_back(candidate);
        }
        move_out(buried);
    }

    void move_out(const std::vector<Candidate>& buried) {
        std::vector<Position> higher;
        std::vector<Candidate> moved;
        for (const Candidate& candidate : buried) {
            const bool ours = in_sector(candidate.position);
            const std::optional<Position> place = free_place(candidate.position);
            if (!place) {
                if (ours)
                    ++report_.dropped_in_solid;
                continue;
            }
            const auto near_place = [&](const Position& other) { return is_near(*place, other); };
            const bool yields = std::ranges::any_of(higher, near_place);
            higher.push_back(*place);
            if (yields || near_kept(*place))
                continue;
            if (ours)
                ++report_.moved_out;
            Candidate at_place = candidate;
            at_place.position = *place;
            moved.push_back(at_place);
        }
        kept_.insert(kept_.end(), moved.begin(), moved.end());
    }

    // This sector's own probes, no more than find room beside the manual ones.
    std::vector<PlacedProbe> thinned(std::size_t manual_count) {
        std::vector<Candidate> own;
        const auto is_ours = [&](const Candidate& candidate) { return in_sector(candidate.position); };
        std::ranges::copy_if(kept_, std::back_inserter(own), is_ours);
        Thinned left = thin(own, settings_.min_distance_m, max_probes - manual_count);
        report_.used_distance_m = left.used_distance_m;
        report_.thinned = static_cast<std::uint32_t>(own.size() - left.probes.size());
        return std::move(left.probes);
    }

    const Input& input_;
    const Surroundings& surroundings_;
    const Settings& settings_;
    const std::int64_t min_squared_;
    const std::vector<Position> manual_;  // of the whole map
    std::vector<Candidate> kept_;         // by priority, the moved ones last
    Report report_;
};

}  // namespace

glm::vec3 metres(const Position& position) {
    return glm::vec3(position) * (1.0f / units_per_m);
}

float decision_margin_m(const Settings& settings) {
    // A decision waits for those of higher classes, one step of at most the distance each: the ground's and
    // the vegetation's classes, then the moved ones, which also went up to half the distance.
    const std::uint32_t ground = lattice_stride(ground_lattice_m, settings.min_distance_m);
    const std::uint32_t vegetation = lattice_stride(vegetation_lattice_m, settings.min_distance_m);
    const std::uint32_t steps = ground * ground + vegetation * vegetation + 2;
    return settings.min_distance_m * static_cast<float>(steps);
}

tl::expected<Placement, std::string> place_probes(const Input& input,
                                                  const Surroundings& surroundings,
                                                  const Settings& settings) {
    return Placer(input, surroundings, settings).run();
}

}  // namespace drtv::placement
