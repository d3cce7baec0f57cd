#include "placement/candidates.h"

#include "placement/floors.h"
#include "placement/units.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <compare>
#include <utility>

namespace drtv::placement {
namespace {

// SplitMix64's finaliser (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

struct Column {
    std::int32_t a;  // lattice coordinates
    std::int32_t b;
    double x_m;
    double y_m;
};

// Visits the columns of a lattice in a square; a column stands in the middle of its lattice square.
template <class Visit>
void visit_columns(double lattice_m, const Square& square, Visit visit) {
    const double half_m = lattice_m / 2;
    const auto first = [&](double m) {
        return static_cast<std::int32_t>(std::ceil((m - half_m) / lattice_m));
    };
    const auto middle_m = [&](std::int32_t n) { return n * lattice_m + half_m; };
    for (std::int32_t b = first(square.low.y); middle_m(b) < square.high.y; ++b) {
        for (std::int32_t a = first(square.low.x); middle_m(a) < square.high.x; ++a)
            visit(Column{a, b, middle_m(a), middle_m(b)});
    }
}

float distance_at(const Position& position, const Input& input, const PlacementSettings& settings) {
    float distance_m = settings.min_distance_m;
    bool in_volume = false;
    const glm::dvec3 point(metres(position));
    for (const SpacingVolume& spacing : input.spacings) {
        if (!spacing.volume.contains(point))
            continue;
        distance_m = in_volume ? std::min(distance_m, spacing.min_distance_m) : spacing.min_distance_m;
        in_volume = true;
    }
    return distance_m;
}

// Collects the proposals of one column, from the bottom up.
class ColumnProposals {
  public:
    ColumnProposals(const Column& column,
                    const Candidate& like,
                    std::uint32_t stride,
                    std::vector<Candidate>& out)
        : out_(out), next_(like) {
        next_.position.x = to_units(column.x_m);
        next_.position.y = to_units(column.y_m);
        next_.lattice_class = lattice_class_of(column.a, column.b, stride);
        const auto a = static_cast<std::uint32_t>(column.a);
        const auto b = static_cast<std::uint32_t>(column.b);
        next_.hash = mixed(std::uint64_t{a} << 32 | b);
    }

    void add(double z_m) {
        next_.position.z = to_units(z_m);
        out_.push_back(next_);
        ++next_.level;
    }

  private:
    std::vector<Candidate>& out_;
    Candidate next_;
};

void propose_on_ground(const std::vector<ColumnHit>& hits, ColumnProposals proposals) {
    for (const Floor& floor : floors_of(hits)) {
        if (floor.free_m >= min_free_height_m)
            proposals.add(double{floor.z_m} + std::min(probe_height_m, floor.free_m / 2));
    }
}

// An interval of height.
struct Height {
    float low_m;
    float high_m;

    auto operator<=>(const Height&) const = default;
};

bool stands_under(const Column& column, const Box& box) {
    const bool in_x = column.x_m >= box.low.x && column.x_m <= box.high.x;
    const bool in_y = column.y_m >= box.low.y && column.y_m <= box.high.y;
    return in_x && in_y;
}

// Tops of the combined boxes over a point: intervals of height that overlap are one plant, or one thicket.
void propose_on_vegetation(const Column& column, std::span<const Box> vegetation, ColumnProposals proposals) {
    std::vector<Height> boxes;
    for (const Box& box : vegetation) {
        if (stands_under(column, box))
            boxes.push_back({box.low.z, box.high.z});
    }
    std::sort(boxes.begin(), boxes.end());
    for (std::size_t n = 0; n < boxes.size();) {
        float top_m = boxes[n].high_m;
        for (++n; n < boxes.size() && boxes[n].low_m <= top_m; ++n)
            top_m = std::max(top_m, boxes[n].high_m);
        proposals.add(double{top_m} + probe_height_m);
    }
}

// The part of the square over which volumes of that distance reach.
Square part_with(float distance_m, const Square& square, std::span<const SpacingVolume> spacings) {
    Square part{square.high, square.low};
    for (const SpacingVolume& spacing : spacings) {
        if (spacing.min_distance_m != distance_m)
            continue;
        part.low = glm::min(part.low, glm::dvec2(spacing.volume.low()));
        part.high = glm::max(part.high, glm::dvec2(spacing.volume.high()));
    }
    return {glm::max(part.low, square.low), glm::min(part.high, square.high)};
}

}  // namespace

std::uint32_t lattice_class_of(std::int32_t a, std::int32_t b, std::uint32_t stride) {
    const std::uint32_t x = static_cast<std::uint32_t>(a) & (stride - 1);
    const std::uint32_t y = static_cast<std::uint32_t>(b) & (stride - 1);
    std::uint32_t value = 0;
    for (std::uint32_t bit = 1; bit < stride; bit <<= 1) {
        const std::uint32_t differs = ((x ^ y) & bit) != 0 ? 2 : 0;
        const std::uint32_t odd_row = (y & bit) != 0 ? 1 : 0;
        value = value * 4 + differs + odd_row;
    }
    return value;
}

std::uint32_t lattice_stride(float lattice_m, float min_distance_m) {
    const std::int64_t lattice = to_units(double{lattice_m});
    const std::int64_t distance = to_units(double{min_distance_m});
    std::uint32_t stride = 1;
    while (stride * lattice < distance)
        stride *= 2;
    return stride;
}

// In whole units, as distances are compared: then neighbours on it do not compete.
float lattice_side_m(Kind kind, float min_distance_m) {
    const float distance_m = static_cast<float>(to_units(double{min_distance_m})) / units_per_m;
    return kind == Kind::vegetation ? std::min(vegetation_lattice_m, 2 * distance_m)
                                    : std::min(ground_lattice_m, distance_m);
}

std::vector<float> distances_kept(const PlacementSettings& settings,
                                  std::span<const SpacingVolume> spacings) {
    std::vector<float> distances = {settings.min_distance_m};
    for (const SpacingVolume& spacing : spacings) {
        if (std::ranges::find(distances, spacing.min_distance_m) == distances.end())
            distances.push_back(spacing.min_distance_m);
    }
    return distances;
}

std::vector<Candidate> propose(const Square& square,
                               const Input& input,
                               const SceneQueries& queries,
                               const PlacementSettings& settings) {
    std::vector<Candidate> candidates;
    std::vector<ColumnHit> hits;
    for (const float distance_m : distances_kept(settings, input.spacings)) {
        const std::size_t first = candidates.size();
        const Square part =
            distance_m == settings.min_distance_m ? square : part_with(distance_m, square, input.spacings);
        for (const Kind kind : {Kind::ground, Kind::vegetation}) {
            Candidate like;
            like.kind = kind;
            like.min_distance_m = distance_m;
            const float lattice_m = lattice_side_m(kind, distance_m);
            const std::uint32_t stride = lattice_stride(lattice_m, distance_m);
            visit_columns(double{lattice_m}, part, [&](const Column& column) {
                const ColumnProposals proposals(column, like, stride, candidates);
                if (kind == Kind::vegetation) {
                    propose_on_vegetation(column, input.vegetation, proposals);
                    return;
                }
                queries.column({column.x_m, column.y_m}, hits);
                propose_on_ground(hits, proposals);
            });
        }
        // Of each place those of its own distance stay.
        const auto is_elsewhere = [&](const Candidate& candidate) {
            return distance_at(candidate.position, input, settings) != distance_m;
        };
        const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(first);
        if (!input.spacings.empty())
            candidates.erase(std::remove_if(begin, candidates.end(), is_elsewhere), candidates.end());
    }
    std::ranges::sort(candidates, {}, &Candidate::priority);
    return candidates;
}

}  // namespace drtv::placement
