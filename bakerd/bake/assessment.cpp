#include "bakerd/bake/assessment.h"

#include "bakerd/bake/integrate.h"
#include "bakerd/bake/path.h"
#include "bakerd/bake/static_gain.h"

#include <drtv/conventions.h>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

namespace drtv::bake {
namespace {

using map::Bounds;
using placement::Position;

// More than any tolerance.
constexpr float unbounded = 1;

constexpr float sector_m = static_cast<float>(map::sector_size_m);

// How far coordinates of rays and of things may be wrong together, with a good reserve.
float slack_m(const Bounds& bounds, float reach_m) {
    const float farthest = std::max({std::abs(bounds.low.x),
                                     std::abs(bounds.low.y),
                                     std::abs(bounds.low.z),
                                     std::abs(bounds.high.x),
                                     std::abs(bounds.high.y),
                                     std::abs(bounds.high.z)});
    return 0.02f + (farthest + reach_m) * 0x1p-17f;
}

Bounds grown(const Bounds& bounds, const glm::vec3& by) {
    return {bounds.low - by, bounds.high + by};
}

bool overlap(const Bounds& a, const Bounds& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
           a.low.z <= b.high.z && b.low.z <= a.high.z;
}

float distance(const Bounds& bounds, const glm::vec3& point) {
    return glm::length(point - glm::clamp(point, bounds.low, bounds.high));
}

// The distance at which a ray enters a box; infinity when it passes it by.
float entry_distance(const glm::vec3& origin, const glm::vec3& direction, const Bounds& box) {
    float enter = 0, leave = std::numeric_limits<float>::infinity();
    for (glm::length_t k = 0; k < 3; ++k) {
        const float inverse = 1 / (std::abs(direction[k]) < 1e-12f ? 1e-12f : direction[k]);
        const float a = (box.low[k] - origin[k]) * inverse, b = (box.high[k] - origin[k]) * inverse;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? enter : std::numeric_limits<float>::infinity();
}

// Whether a square of the plan holds a point of a lattice with `step_m` metres between points, the first in
// the middle of its square.
bool holds_lattice_point(const Bounds& bounds, float step_m) {
    const auto between = [step_m](float low, float high) {
        return std::floor((high - step_m / 2) / step_m) >= std::ceil((low - step_m / 2) / step_m);
    };
    return between(bounds.low.x, bounds.high.x) && between(bounds.low.y, bounds.high.y);
}

// The part of the plane of sample numbers (uniform_sphere) in which the directions to a box lie; turns of the
// azimuth, counted from its middle.
struct Window {
    float low_x = 0, high_x = 1;           // of u.x
    float middle_y = 0, half_width_y = 1;  // of u.y

    [[nodiscard]] bool meets(float x0, float x1, float y0, float y1) const {
        if (x1 < low_x || x0 > high_x)
            return false;
        const float middle = (y0 + y1) / 2, off = std::abs(middle - middle_y);
        return std::min(off, 1 - off) <= half_width_y + (y1 - y0) / 2;
    }
};

Window window_of(const glm::vec3& from, const Bounds& box) {
    constexpr float rounding = 1e-4f;  // far more than what C libraries make of an arc tangent
    const glm::vec3 low = box.low - from, high = box.high - from;
    const glm::vec2 nearest(std::max({low.x, -high.x, 0.0f}), std::max({low.y, -high.y, 0.0f}));
    const glm::vec2 farthest(std::max(std::abs(low.x), std::abs(high.x)),
                             std::max(std::abs(low.y), std::abs(high.y)));
    const float near = glm::length(nearest), far = glm::length(farthest);
    // The sine of the height over the horizon grows with the height, and falls with the distance where it is
    // above.
    const auto sine = [](float height, float plan) {
        return height == 0 && plan == 0 ? 1.0f : height / std::sqrt(height * height + plan * plan);
    };
    const float highest = near == 0 && high.z > 0 ? 1 : sine(high.z, high.z > 0 ? near : far),
                lowest = near == 0 && low.z < 0 ? -1 : sine(low.z, low.z > 0 ? far : near);
    Window window;
    window.low_x = (1 - highest) / 2 - rounding;
    window.high_x = (1 - lowest) / 2 + rounding;
    if (near == 0)
        return window;
    constexpr float turns = 0.5f * std::numbers::inv_pi_v<float>;
    const glm::vec2 middle = glm::vec2(low + high) / 2.0f;
    window.middle_y = std::atan2(middle.y, middle.x) * turns;
    window.middle_y -= std::floor(window.middle_y);
    window.half_width_y = 0;
    for (const float x : {low.x, high.x}) {
        for (const float y : {low.y, high.y}) {
            // The angle between two directions of the plan; the box does not hold the start, so it is below
            // half a turn.
            const float across = middle.x * y - middle.y * x, along = middle.x * x + middle.y * y;
            window.half_width_y = std::max(window.half_width_y, std::abs(std::atan2(across, along)) * turns);
        }
    }
    window.half_width_y += rounding;
    return window;
}

// Of the first rays of all probes, those that reach boxes.
class FirstRays {
  public:
    FirstRays(const Footprint& footprint, const SampleTable& samples, const trace::Scene& scene)
        : footprint_(footprint), samples_(samples), scene_(scene) {
        for (const ProbeRecord& record : footprint.probes) {
            Probe& probe = probes_.emplace_back();
            probe.place = placement::metres(record.position);
            probe.shift = digital_shift(record.position);
            for (std::uint32_t first = 0; first < samples.count(); first += group_size) {
                Group& group = probe.groups.emplace_back();
                for (const std::uint32_t n : members(first / group_size)) {
                    const glm::vec2 u = shifted(samples.point(n), probe.shift, 0);
                    group.x0 = std::min(group.x0, u.x);
                    group.x1 = std::max(group.x1, u.x);
                    group.y0 = std::min(group.y0, u.y);
                    group.y1 = std::max(group.y1, u.y);
                }
            }
        }
    }

    // The largest share of a coefficient of a probe that rays into one of the boxes have. Above 0 when there
    // are such rays at all. REQUIRES: what changed lies inside the boxes.
    [[nodiscard]] float share_of(std::size_t number, std::span<const Bounds> boxes) const {
        const Probe& probe = probes_[number];
        std::array<float, basis_count> sums{};
        std::vector<Window> windows;
        for (const Bounds& box : boxes) {
            if (distance(box, probe.place) <= farthest_m())
                windows.push_back(window_of(probe.place, box));
        }
        if (windows.empty())
            return 0;
        for (std::uint32_t g = 0; g < probe.groups.size(); ++g) {
            const Group& group = probe.groups[g];
            if (std::ranges::none_of(windows, [&](const Window& window) {
                    return window.meets(group.x0, group.x1, group.y0, group.y1);
                }))
                continue;
            for (const std::uint32_t n : members(g)) {
                const glm::vec3 direction = uniform_sphere(shifted(samples_.point(n), probe.shift, 0));
                float enter = std::numeric_limits<float>::infinity();
                for (const Bounds& box : boxes)
                    enter = std::min(enter, entry_distance(probe.place, direction, box));
                if (!(enter <= farthest_m()) ||
                    !may_come_to({probe.place, direction, footprint_.reach_m}, enter))
                    continue;
                // Sky visibility is a mean over the upper half alone: so much more does a ray of it count
                // there.
                constexpr float upper_gain = 1.26794919f;
                for (std::size_t b = 0; b < basis_count; ++b) {
                    const float cosine = direction.x * transfer_basis[b][0] +
                                         direction.y * transfer_basis[b][1] +
                                         direction.z * transfer_basis[b][2];
                    sums[b] += std::max(cosine, 1e-6f) * (direction.z > 0 ? upper_gain : 1);
                }
            }
        }
        return *std::ranges::max_element(sums) * 4 / static_cast<float>(samples_.count());
    }

  private:
    // A step over a surface at the end of the reach may end behind it, by less than half of the way
    // (before_surface).
    [[nodiscard]] float farthest_m() const { return footprint_.reach_m * 1.5f; }

    // Whether anything is asked about what lies `enter_m` along a first ray, or beyond. What stops the ray
    // before is in both maps; where it is let through, so is all that it was asked for just behind.
    [[nodiscard]] bool may_come_to(const trace::Ray& ray, float enter_m) const {
        if (enter_m <= 0)
            return true;
        const auto steps_over = [&](const trace::Ray& first) {
            const auto hit = scene_.closest({first.origin, first.direction, std::min(enter_m, first.far_m)});
            return hit ? std::optional(end_of_beyond_surface(first, *hit) >= enter_m) : std::nullopt;
        };
        if (const auto over = steps_over(ray))
            return *over;
        // The first misses are looked at twice (integrate.cpp).
        return enter_m <= ray.far_m || steps_over(trace::beside(ray)).value_or(false);
    }

    // Samples that start side by side, and what they span of their numbers.
    static constexpr std::uint32_t group_size = 8;
    struct Group {
        float x0 = 1, x1 = 0, y0 = 1, y1 = 0;
    };
    struct Probe {
        glm::vec3 place{};
        std::array<std::uint32_t, max_sample_dimensions> shift{};
        std::vector<Group> groups;
    };

    [[nodiscard]] std::span<const std::uint32_t> members(std::uint32_t group) const {
        const std::size_t first = std::size_t{group} * group_size;
        return samples_.side_by_side().subspan(first,
                                               std::min<std::size_t>(group_size, samples_.count() - first));
    }

    const Footprint& footprint_;
    const SampleTable& samples_;
    const trace::Scene& scene_;
    std::vector<Probe> probes_;
};

class Assessor {
  public:
    Assessor(const Footprint& footprint, const Settings& settings, float tolerance, World& world)
        : footprint_(footprint),
          settings_(settings),
          tolerance_(footprint.without_bounds ? 0 : tolerance),
          world_(world),
          counted_(footprint.grid.block_count(), false),
          flips_(footprint.solid_tests.size(), 0) {
        const float x = static_cast<float>(footprint.sector.i) * sector_m,
                    y = static_cast<float>(footprint.sector.j) * sector_m,
                    infinity = std::numeric_limits<float>::infinity();
        square_ = {{x, y, -infinity}, {x + sector_m, y + sector_m, infinity}};
    }

    Assessment run(std::span<const Change> changes) {
        // One for all: a path that one change lets through may find what another has put beside a lamp.
        std::vector<Bounds> boxes;
        for (const Change& change : changes)
            std::ranges::copy(boxes_of(change), std::back_inserter(boxes));
        std::erase_if(boxes, [&](const Bounds& box) { return !within_reach({&box, 1}); });
        const float before = footprint_.most_scattered, now = std::max(before, world_.most_scattered());
        assessment_.static_gain = raised_gain(footprint_.static_gain, before, now, settings_) +
                                  static_gain(world_.lights(), now, boxes, settings_);
        assessment_.gain = std::max(1.0f, assessment_.static_gain);
        for (const ProbeRecord& probe : footprint_.probes)
            assessment_.probe_bounds.push_back(probe.share * assessment_.gain);
        for (std::size_t n = 0; n < changes.size() && !settled(); ++n) {
            const auto [weight, cause] = weigh(changes[n]);
            if (!(weight > 0) || (assessment_.change && weight <= assessment_.weight))
                continue;
            assessment_.change = n;
            assessment_.cause = cause;
            assessment_.weight = weight;
        }
        for (const float bound : assessment_.probe_bounds)
            assessment_.bound = std::max(assessment_.bound, bound);
        if (!assessment_.placement_holds)
            assessment_.bound = unbounded;
        assessment_.verdict = assessment_.bound > tolerance_ ? Verdict::rebake
                              : assessment_.bound > 0        ? Verdict::near_hit
                                                             : Verdict::hit;
        for (const std::uint32_t flips : flips_)
            assessment_.flips.push_back(static_cast<std::uint8_t>(std::popcount(flips)));
        // Local transfer is of all probes together, and a number of rays that follows from what they find is
        // in no record. Of a scene with other heights the record cannot go on.
        const bool alone =
            footprint_.without_bounds || (assessment_.verdict == Verdict::rebake && !settled() &&
                                          footprint_grid(footprint_.sector,
                                                         scene_distance_m(settings_),
                                                         scene().bounds().low.z,
                                                         scene().bounds().high.z) != footprint_.grid);
        if (alone)
            assessment_.probe_bounds.clear();
        return std::move(assessment_);
    }

  private:
    struct Weighed {
        float weight = 0;
        Cause cause = Cause::rays;
    };

    [[nodiscard]] bool over(float bound) const { return bound > tolerance_; }

    // Nothing can be taken over.
    [[nodiscard]] bool settled() const {
        return !assessment_.placement_holds &&
               std::ranges::all_of(assessment_.probe_bounds, [&](float bound) { return over(bound); });
    }

    // Counts the change in.
    Weighed weigh(const Change& change) {
        Weighed weighed;
        const auto count = [&](Cause cause, float weight) {
            if (weight > weighed.weight)
                weighed = {weight, cause};
        };
        const auto placement_fails = [&](Cause cause) {
            assessment_.placement_holds = false;
            count(cause, unbounded);
        };
        for (const std::optional<Item>* item : {&change.before, &change.after}) {
            if (!*item)
                continue;
            if (const std::optional<Cause> cause = moves_probes(**item))
                placement_fails(*cause);
            if (shine_on_probes(**item))
                count(Cause::light, unbounded);
        }
        const std::vector<Bounds> boxes = boxes_of(change);
        if (assessment_.placement_holds && flips_placement(boxes))
            placement_fails(Cause::placement);
        if (within_reach(boxes))
            count(Cause::rays, count_rays(boxes));
        return weighed;
    }

    // Where geometry was and is.
    [[nodiscard]] std::vector<Bounds> boxes_of(const Change& change) const {
        std::vector<Bounds> boxes;
        for (const std::optional<Item>* item : {&change.before, &change.after}) {
            if (!*item || ((*item)->kind != ItemKind::fixed && (*item)->kind != ItemKind::vegetation))
                continue;
            boxes.push_back(grown((*item)->bounds, glm::vec3(slack_m((*item)->bounds, footprint_.reach_m))));
        }
        return boxes;
    }

    // Gives the most that the boxes change of any probe.
    float count_rays(std::span<const Bounds> boxes) {
        const float gain = assessment_.gain;
        const std::array<float, quarter_count> later = later_shares(boxes);
        float most = 0;
        for (std::size_t p = 0; p < footprint_.probes.size(); ++p) {
            float& bound = assessment_.probe_bounds[p];
            float share = later[quarter_of(footprint_.sector, footprint_.probes[p].position)] * gain;
            // No need to look for more than what settles it.
            if (!over(bound + share))
                share += first_rays().share_of(p, boxes) * gain;
            bound += share;
            most = std::max(most, share);
        }
        return most;
    }

    // Where placement certainly asked. Why it may come out otherwise.
    [[nodiscard]] std::optional<Cause> moves_probes(const Item& item) const {
        const auto within = [&](float metres) {
            return overlap(item.bounds, grown(square_, {metres, metres, 0}));
        };
        switch (item.kind) {
            case ItemKind::fixed:
            case ItemKind::vegetation: {
                const Bounds bounds = grown(item.bounds, glm::vec3(slack_m(item.bounds, footprint_.reach_m)));
                // The grid's cells look for their probes all over the sector; columns stand on their
                // lattices.
                if (overlap(bounds, square_))
                    return Cause::placement;
                const float lattice_m =
                    static_cast<float>(item.kind == ItemKind::vegetation ? placement::vegetation_lattice_m
                                                                         : placement::ground_lattice_m);
                if (overlap(bounds, grown(square_, {footprint_.placement_m, footprint_.placement_m, 0})) &&
                    holds_lattice_point(bounds, lattice_m))
                    return Cause::placement;
                return std::nullopt;
            }
            case ItemKind::manual_probe:
            case ItemKind::no_probes:
                // As far as candidates stand and may be moved, and keep their distance.
                if (within(footprint_.placement_m + 2 * footprint_.min_distance_m))
                    return Cause::placement;
                return std::nullopt;
            case ItemKind::interior:
                if (within(position_unit_m))
                    return Cause::interior;
                return std::nullopt;
            case ItemKind::lamp:
            case ItemKind::sun:
                return std::nullopt;
        }
        return Cause::placement;
    }

    // Lights within reach are in a probe's tree, seen or not. Whether it is one of any probe's.
    bool shine_on_probes(const Item& item) {
        const bool emissive =
                       item.emissive && (item.kind == ItemKind::fixed || item.kind == ItemKind::vegetation),
                   everywhere = item.kind == ItemKind::sun;
        if (!emissive && !everywhere && item.kind != ItemKind::lamp)
            return false;
        const glm::vec3 centre = (item.bounds.low + item.bounds.high) * 0.5f;
        // The emissive part, which is what counts, may lie at one end and be as large as the whole.
        const float diagonal_m = glm::length(item.bounds.high - item.bounds.low),
                    reach_m = footprint_.reach_m + diagonal_m + 2 * slack_m(item.bounds, footprint_.reach_m);
        bool any = false;
        for (std::size_t p = 0; p < footprint_.probes.size(); ++p) {
            if (!everywhere &&
                glm::distance(placement::metres(footprint_.probes[p].position), centre) > reach_m)
                continue;
            assessment_.probe_bounds[p] = std::max(assessment_.probe_bounds[p], unbounded);
            any = true;
        }
        return any;
    }

    [[nodiscard]] bool within_reach(std::span<const Bounds> boxes) const {
        const glm::vec3 low = footprint_.grid.low(), high = footprint_.grid.high();
        const float infinity = std::numeric_limits<float>::infinity();
        const Bounds reached{{low.x, low.y, -infinity}, {high.x, high.y, infinity}};
        return !footprint_.probes.empty() &&
               std::ranges::any_of(boxes, [&](const Bounds& box) { return overlap(box, reached); });
    }

    // Whether enough test rays of a point may end otherwise, by these boxes and those before.
    [[nodiscard]] bool flips_placement(std::span<const Bounds> boxes) {
        const std::span<const glm::vec3> directions = placement::solid_test_directions();
        for (std::size_t n = 0; n < footprint_.solid_tests.size(); ++n) {
            const SolidTest& test = footprint_.solid_tests[n];
            const glm::vec3 place = placement::metres(test.position);
            if (std::ranges::none_of(
                    boxes, [&](const Bounds& box) { return distance(box, place) <= footprint_.reach_m; }))
                continue;
            for (std::size_t d = 0; d < directions.size(); ++d) {
                if ((flips_[n] >> d & 1u) != 0)
                    continue;
                if (std::ranges::any_of(boxes, [&](const Bounds& box) {
                        return entry_distance(place, directions[d], box) <= footprint_.reach_m;
                    }))
                    flips_[n] |= 1u << d;
            }
            if (std::popcount(flips_[n]) >= test.to_flip)
                return true;
        }
        return false;
    }

    // By quarter: of blocks not counted before, where rays crossed one of the boxes' cells.
    [[nodiscard]] std::array<float, quarter_count> later_shares(std::span<const Bounds> boxes) {
        const FootprintGrid& grid = footprint_.grid;
        const glm::vec3 cell(grid.cell_m, grid.cell_m, grid.layer_m),
            last(grid.columns - 1, grid.rows - 1, grid.layers - 1);
        std::array<float, quarter_count> shares{};
        for (const Bounds& box : boxes) {
            // Above and below the grid rays go unseen.
            if (box.low.z < grid.low().z || box.high.z > grid.high().z)
                shares.fill(unbounded);
            if (!overlap(box, {grid.low(), grid.high()}))
                continue;
            const glm::ivec3 from(glm::clamp(glm::floor((box.low - grid.low()) / cell), glm::vec3(0), last)),
                to(glm::clamp(glm::floor((box.high - grid.low()) / cell), glm::vec3(0), last));
            for (std::int32_t j = from.y; j <= to.y; ++j) {
                for (std::int32_t i = from.x; i <= to.x; ++i) {
                    std::uint64_t crossed =
                        footprint_.crossed[grid.column(i, j)] & layers_between(from.z, to.z);
                    for (; crossed != 0; crossed &= crossed - 1) {
                        const std::size_t block = grid.block(i, j, std::countr_zero(crossed));
                        if (counted_[block])
                            continue;
                        counted_[block] = true;
                        for (std::size_t quarter = 0; quarter < quarter_count; ++quarter)
                            shares[quarter] += weight_of_code(footprint_.weight(block, quarter));
                    }
                }
            }
        }
        return shares;
    }

    const trace::Scene& scene() {
        if (!scene_)
            scene_ = world_.scene_for(footprint_.sector, scene_distance_m(settings_));
        return *scene_;
    }

    // Made when first needed: most results are asked about things far away.
    const FirstRays& first_rays() {
        if (!first_rays_) {
            samples_ = world_.samples(settings_.rays,
                                      sample_dimensions(settings_.bounces, !world_.lights().empty()));
            first_rays_.emplace(footprint_, *samples_, scene());
        }
        return *first_rays_;
    }

    const Footprint& footprint_;
    const Settings& settings_;
    const float tolerance_;
    World& world_;
    Assessment assessment_;
    Bounds square_;
    std::vector<bool> counted_;         // blocks
    std::vector<std::uint32_t> flips_;  // by solid test: the rays that may end otherwise
    std::shared_ptr<const trace::Scene> scene_;
    std::shared_ptr<const SampleTable> samples_;
    std::optional<FirstRays> first_rays_;
};

}  // namespace

Assessment assess(const Footprint& footprint,
                  const Settings& settings,
                  std::span<const Change> changes,
                  float tolerance,
                  World& world) {
    return Assessor(footprint, settings, tolerance, world).run(changes);
}

float share_to_bake(const Assessment& assessment, float tolerance) {
    if (assessment.probe_bounds.empty())
        return 1;
    const auto over =
        std::ranges::count_if(assessment.probe_bounds, [&](float bound) { return bound > tolerance; });
    return static_cast<float>(over) / static_cast<float>(assessment.probe_bounds.size());
}

std::string describe(const Assessment& assessment, std::span<const Change> changes) {
    if (!assessment.change)
        return assessment.verdict == Verdict::rebake ? "what is kept of it may be off by more than is asked"
                                                     : "";
    const Change& change = changes[*assessment.change];
    const auto how = [&]() -> std::string {
        switch (assessment.cause) {
            case Cause::rays: {
                const glm::vec3 middle = (change.item().bounds.low + change.item().bounds.high) * 0.5f;
                const auto column = [](float metres) {
                    return static_cast<std::int32_t>(std::floor(metres / sector_m));
                };
                if (assessment.weight >= unbounded)
                    return fmt::format("rays cross column ({}, {})", column(middle.x), column(middle.y));
                return fmt::format("rays cross column ({}, {}), weight {:.2g} %",
                                   column(middle.x),
                                   column(middle.y),
                                   assessment.weight * 100);
            }
            case Cause::placement:
                return "it may move probes";
            case Cause::light:
                return "it shines here";
            case Cause::interior:
                return "its probe stands here";
        }
        return "";
    };
    return fmt::format("{}: {}", describe(change), how());
}

}  // namespace drtv::bake
