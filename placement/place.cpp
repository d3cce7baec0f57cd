// The decisions. Manual probes stand; then proposals in the order of their priority, each kept if no kept one
// is nearer than the minimal distance; last, those that stood in a solid and found a free place nearby. A
// moved probe yields to any moved one of higher priority near it, kept or not: so no chain of decisions runs
// far.
#include "placement/placement.h"

#include "placement/candidates.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

namespace drtv::placement {
namespace {

// Of 26 test rays; more, and the probe is inside something.
constexpr std::size_t most_backs = 6;

// The 26 directions from a cube's centre to its faces, edges and corners; up first, so that a probe that must
// move goes up rather than sideways.
std::array<glm::vec3, 26> make_test_directions() {
    std::array<glm::vec3, 26> directions;
    std::size_t n = 0;
    for (int z : {1, 0, -1}) {
        for (int nonzero = 0; nonzero <= 2; ++nonzero) {
            for (int y : {0, 1, -1}) {
                for (int x : {0, 1, -1}) {
                    if (std::abs(x) + std::abs(y) == nonzero && (x != 0 || y != 0 || z != 0))
                        directions[n++] = glm::normalize(glm::vec3(x, y, z));
                }
            }
        }
    }
    return directions;
}

const std::array<glm::vec3, 26> test_directions = make_test_directions();

std::int64_t squared_distance(const Position& a, const Position& b) {
    const std::int64_t x = std::int64_t{a.x} - b.x, y = std::int64_t{a.y} - b.y, z = std::int64_t{a.z} - b.z;
    return x * x + y * y + z * z;
}

std::int64_t squared_units(float distance_m) {
    const auto units = static_cast<std::int64_t>(std::lround(static_cast<double>(distance_m) * units_per_m));
    return units * units;
}

class Placer {
  public:
    Placer(const Input& input, const Surroundings& surroundings, const Settings& settings)
        : input_(input),
          surroundings_(surroundings),
          settings_(settings),
          min_squared_(squared_units(settings.min_distance_m)) {}

    tl::expected<Placement, std::string> run() {
        for (const glm::dvec3& m : input_.manual)
            manual_.push_back(Position(std::lround(m.x * units_per_m),
                                       std::lround(m.y * units_per_m),
                                       std::lround(m.z * units_per_m)));
        std::sort(manual_.begin(), manual_.end(), [](const Position& a, const Position& b) {
            return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
        });
        manual_.erase(std::unique(manual_.begin(), manual_.end()), manual_.end());
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
        std::vector<PlacedProbe> automatic = thin(placement.probes.size());
        // An order that no change elsewhere in the sector disturbs much.
        std::sort(automatic.begin(), automatic.end(), [](const PlacedProbe& a, const PlacedProbe& b) {
            return std::tie(a.position.y, a.position.x, a.position.z) <
                   std::tie(b.position.y, b.position.x, b.position.z);
        });
        placement.probes.insert(placement.probes.end(), automatic.begin(), automatic.end());
        placement.report = report_;
        return placement;
    }

  private:
    struct Kept {
        Candidate candidate;
        bool moved = false;
    };

    [[nodiscard]] bool in_sector(const Position& p) const {
        constexpr std::int32_t side = sector_size_m * units_per_m;
        const std::int64_t x = std::int64_t{p.x} - std::int64_t{input_.i} * side,
                           y = std::int64_t{p.y} - std::int64_t{input_.j} * side;
        return x >= 0 && x < side && y >= 0 && y < side;
    }

    [[nodiscard]] bool in_solid(const Position& position) const {
        return is_in_solid(surroundings_.backs_met(metres(position), test_directions));
    }

    [[nodiscard]] bool in_volume(const Position& position) const {
        const glm::dvec3 point(metres(position));
        return std::any_of(input_.no_probes.begin(), input_.no_probes.end(), [&](const ClosedVolume& volume) {
            return volume.contains(point);
        });
    }

    [[nodiscard]] bool near_kept(const Position& position) const {
        const auto near = [&](const Position& other) {
            return squared_distance(position, other) < min_squared_;
        };
        return std::any_of(manual_.begin(), manual_.end(), near) ||
               std::any_of(
                   kept_.begin(), kept_.end(), [&](const Kept& k) { return near(k.candidate.position); });
    }

    // The nearest free place within half the spacing, in the same sector.
    [[nodiscard]] std::optional<Position> free_place(const Position& from) const {
        constexpr std::int32_t side = sector_size_m * units_per_m;
        const auto sector_of = [](std::int32_t u) { return u >= 0 ? u / side : -((-u + side - 1) / side); };
        for (float share : {0.125f, 0.25f, 0.5f}) {
            for (const glm::vec3& direction : test_directions) {
                // Truncated towards zero, so that the way stays within half the spacing.
                const Position place = from + Position(direction * (share * settings_.min_distance_m *
                                                                    static_cast<float>(units_per_m)));
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
        for (const Candidate& candidate : propose(corner - margin_m,
                                                  corner + double{sector_size_m} + margin_m,
                                                  input_.vegetation,
                                                  surroundings_,
                                                  settings_)) {
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
                kept_.push_back({candidate});
        }
        move_out(buried);
    }

    void move_out(const std::vector<Candidate>& buried) {
        std::vector<Position> higher;
        std::vector<Kept> moved;
        for (const Candidate& candidate : buried) {
            const bool ours = in_sector(candidate.position);
            const std::optional<Position> place = free_place(candidate.position);
            if (!place) {
                if (ours)
                    ++report_.dropped_in_solid;
                continue;
            }
            const bool yields = std::any_of(higher.begin(), higher.end(), [&](const Position& other) {
                return squared_distance(*place, other) < min_squared_;
            });
            higher.push_back(*place);
            if (yields || near_kept(*place))
                continue;
            if (ours)
                ++report_.moved_out;
            Candidate at_place = candidate;
            at_place.position = *place;
            moved.push_back({at_place, true});
        }
        kept_.insert(kept_.end(), moved.begin(), moved.end());
    }

    // This sector's own probes; past 255 the distance grows by eighths until they fit. Neighbours do not see
    // that, so a border may lose probes by it but never gain one too near. One probe is kept at any distance,
    // so that growing is no way out for a sector that manual ones fill.
    std::vector<PlacedProbe> thin(std::size_t manual_count) {
        std::vector<Candidate> own;
        for (const Kept& kept : kept_) {
            if (in_sector(kept.candidate.position))
                own.push_back(kept.candidate);
        }
        report_.used_distance_m = settings_.min_distance_m;
        std::vector<PlacedProbe> probes;
        for (; manual_count < max_probes; report_.used_distance_m *= 1.125f) {
            const std::int64_t least = squared_units(report_.used_distance_m);
            probes.clear();
            for (const Candidate& candidate : own) {
                const auto near = [&](const PlacedProbe& other) {
                    return squared_distance(candidate.position, other.position) < least;
                };
                if (std::none_of(probes.begin(), probes.end(), near))
                    probes.push_back({candidate.position, candidate.kind});
            }
            if (probes.size() + manual_count <= max_probes)
                break;
        }
        report_.thinned = static_cast<std::uint32_t>(own.size() - probes.size());
        return probes;
    }

    const Input& input_;
    const Surroundings& surroundings_;
    const Settings& settings_;
    const std::int64_t min_squared_;
    std::vector<Position> manual_;  // of the whole map
    std::vector<Kept> kept_;        // by priority
    Report report_;
};

}  // namespace

glm::vec3 metres(const Position& position) {
    return glm::vec3(position) * (1.0f / units_per_m);
}

std::span<const glm::vec3> solid_test_directions() {
    return test_directions;
}

bool is_in_solid(std::size_t backs) {
    return backs > most_backs;
}

std::size_t backs_to_flip(std::size_t backs) {
    return is_in_solid(backs) ? backs - most_backs : most_backs + 1 - backs;
}

float decision_margin_m(const Settings& settings) {
    // A decision waits for those of higher classes, one step of at most the distance each: the ground's and
    // the vegetation's classes, then the moved ones, which also went up to half the distance.
    const std::uint32_t ground = lattice_stride(ground_lattice_m, settings.min_distance_m),
                        vegetation = lattice_stride(vegetation_lattice_m, settings.min_distance_m);
    return settings.min_distance_m * static_cast<float>(ground * ground + vegetation * vegetation + 2);
}

tl::expected<Placement, std::string> place_probes(const Input& input,
                                                  const Surroundings& surroundings,
                                                  const Settings& settings) {
    return Placer(input, surroundings, settings).run();
}

}  // namespace drtv::placement
