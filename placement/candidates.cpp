#include "placement/candidates.h"

#include "placement/units.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>

namespace drtv::placement {
namespace {

// Surfaces closer together than this are one (a column through a shared edge meets both triangles).
constexpr float same_surface_m = 1e-3f;

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
void visit_columns(std::int32_t lattice_m, const Square& square, Visit visit) {
    const double half_m = lattice_m / 2.0;
    const auto first = [&](double m) {
        return static_cast<std::int32_t>(std::ceil((m - half_m) / lattice_m));
    };
    const auto middle_m = [&](std::int32_t n) { return n * lattice_m + half_m; };
    for (std::int32_t b = first(square.low.y); middle_m(b) < square.high.y; ++b) {
        for (std::int32_t a = first(square.low.x); middle_m(a) < square.high.x; ++a)
            visit(Column{a, b, middle_m(a), middle_m(b)});
    }
}

// Collects the proposals of one column, from the bottom up.
class ColumnProposals {
  public:
    ColumnProposals(const Column& column, Kind kind, std::uint32_t stride, std::vector<Candidate>& out)
        : out_(out) {
        next_.position.x = to_units(column.x_m);
        next_.position.y = to_units(column.y_m);
        next_.kind = kind;
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

// Free height above a surface: up to the next one; none when that one is left through its back, because then
// the space between is the inside of something.
float free_height(const std::vector<ColumnHit>& hits, std::size_t surface) {
    for (std::size_t above = surface; above-- > 0;) {
        const float height = hits[above].z_m - hits[surface].z_m;
        if (height < same_surface_m && hits[above].up_facing == hits[surface].up_facing)
            continue;
        return hits[above].down_facing ? height : 0;
    }
    return std::numeric_limits<float>::infinity();
}

void propose_on_ground(const Column& column,
                       const Surroundings& surroundings,
                       std::uint32_t stride,
                       std::vector<ColumnHit>& hits,
                       std::vector<Candidate>& out) {
    surroundings.column({column.x_m, column.y_m}, hits);
    ColumnProposals proposals(column, Kind::ground, stride, out);
    float last_m = -std::numeric_limits<float>::infinity();
    for (std::size_t n = hits.size(); n-- > 0;) {
        const ColumnHit& hit = hits[n];
        if (!hit.up_facing || hit.z_m - last_m < same_surface_m)
            continue;
        const float free_m = free_height(hits, n);
        if (free_m < min_free_height_m)
            continue;
        last_m = hit.z_m;
        const float above_m = std::min(probe_height_m, free_m / 2);
        proposals.add(double{hit.z_m} + above_m);
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
void propose_on_vegetation(const Column& column,
                           std::span<const Box> vegetation,
                           std::uint32_t stride,
                           std::vector<Candidate>& out) {
    std::vector<Height> boxes;
    for (const Box& box : vegetation) {
        if (stands_under(column, box))
            boxes.push_back({box.low.z, box.high.z});
    }
    std::sort(boxes.begin(), boxes.end());
    ColumnProposals proposals(column, Kind::vegetation, stride, out);
    for (std::size_t n = 0; n < boxes.size();) {
        float top_m = boxes[n].high_m;
        for (++n; n < boxes.size() && boxes[n].low_m <= top_m; ++n)
            top_m = std::max(top_m, boxes[n].high_m);
        proposals.add(double{top_m} + probe_height_m);
    }
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

std::uint32_t lattice_stride(std::int32_t lattice_m, float min_distance_m) {
    std::uint32_t stride = 1;
    const auto step_m = static_cast<float>(lattice_m);
    while (static_cast<float>(stride) * step_m < min_distance_m)
        stride *= 2;
    return stride;
}

std::vector<Candidate> propose(const Square& square,
                               std::span<const Box> vegetation,
                               const Surroundings& surroundings,
                               const Settings& settings) {
    std::vector<Candidate> candidates;
    std::vector<ColumnHit> hits;
    const std::uint32_t ground_stride = lattice_stride(ground_lattice_m, settings.min_distance_m);
    visit_columns(ground_lattice_m, square, [&](const Column& column) {
        propose_on_ground(column, surroundings, ground_stride, hits, candidates);
    });
    const std::uint32_t vegetation_stride = lattice_stride(vegetation_lattice_m, settings.min_distance_m);
    visit_columns(vegetation_lattice_m, square, [&](const Column& column) {
        propose_on_vegetation(column, vegetation, vegetation_stride, candidates);
    });
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.priority() < b.priority();
    });
    return candidates;
}

}  // namespace drtv::placement
