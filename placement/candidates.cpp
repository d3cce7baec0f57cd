#include "placement/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::placement {
namespace {

// Surfaces closer together than this are one (a column through a shared edge meets both triangles).
constexpr float same_surface_m = 1e-3f;

std::int32_t to_units(double m) {
    return static_cast<std::int32_t>(std::lround(m * units_per_m));
}

// SplitMix64's finaliser (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

struct Column {
    std::int32_t a, b;  // lattice coordinates
    double x_m, y_m;
};

// Visits the columns of a lattice in a square; a column stands in the middle of its lattice square.
template <class Visit>
void visit_columns(std::int32_t lattice_m, glm::dvec2 low, glm::dvec2 high, Visit visit) {
    const double half_m = lattice_m / 2.0;
    const auto first = [&](double m) {
        return static_cast<std::int32_t>(std::ceil((m - half_m) / lattice_m));
    };
    for (std::int32_t b = first(low.y); b * lattice_m + half_m < high.y; ++b) {
        for (std::int32_t a = first(low.x); a * lattice_m + half_m < high.x; ++a)
            visit(Column{a, b, a * lattice_m + half_m, b * lattice_m + half_m});
    }
}

Candidate candidate_at(
    const Column& column, double z_m, Kind kind, std::uint32_t level, std::uint32_t stride) {
    const auto key = static_cast<std::uint64_t>(static_cast<std::uint32_t>(column.a)) << 32 |
                     static_cast<std::uint32_t>(column.b);
    return {{to_units(column.x_m), to_units(column.y_m), to_units(z_m)},
            kind,
            lattice_class_of(column.a, column.b, stride),
            level,
            mixed(key)};
}

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
    std::uint32_t level = 0;
    float last_m = -std::numeric_limits<float>::infinity();
    for (std::size_t n = hits.size(); n-- > 0;) {
        if (!hits[n].up_facing || hits[n].z_m - last_m < same_surface_m)
            continue;
        const float free_m = free_height(hits, n);
        if (free_m < least_free_height_m)
            continue;
        last_m = hits[n].z_m;
        out.push_back(candidate_at(column,
                                   double{hits[n].z_m} + std::min(probe_height_m, free_m / 2),
                                   Kind::ground,
                                   level++,
                                   stride));
    }
}

// Tops of the combined boxes over a point: intervals of height that overlap are one plant, or one thicket.
void propose_on_vegetation(const Column& column,
                           std::span<const Box> vegetation,
                           std::uint32_t stride,
                           std::vector<Candidate>& out) {
    std::vector<std::pair<float, float>> spans;
    for (const Box& box : vegetation) {
        if (column.x_m >= box.low.x && column.x_m <= box.high.x && column.y_m >= box.low.y &&
            column.y_m <= box.high.y)
            spans.emplace_back(box.low.z, box.high.z);
    }
    std::sort(spans.begin(), spans.end());
    std::uint32_t level = 0;
    for (std::size_t n = 0; n < spans.size();) {
        float top_m = spans[n].second;
        for (++n; n < spans.size() && spans[n].first <= top_m; ++n)
            top_m = std::max(top_m, spans[n].second);
        out.push_back(
            candidate_at(column, double{top_m} + probe_height_m, Kind::vegetation, level++, stride));
    }
}

}  // namespace

std::uint32_t lattice_class_of(std::int32_t a, std::int32_t b, std::uint32_t stride) {
    const std::uint32_t x = static_cast<std::uint32_t>(a) & (stride - 1),
                        y = static_cast<std::uint32_t>(b) & (stride - 1);
    std::uint32_t value = 0;
    for (std::uint32_t bit = 1; bit < stride; bit <<= 1) {
        const std::uint32_t differs = ((x ^ y) & bit) != 0 ? 2 : 0;
        value = value * 4 + differs + ((y & bit) != 0 ? 1 : 0);
    }
    return value;
}

std::uint32_t lattice_stride(std::int32_t lattice_m, float min_distance_m) {
    std::uint32_t stride = 1;
    while (static_cast<float>(stride) * static_cast<float>(lattice_m) < min_distance_m)
        stride *= 2;
    return stride;
}

std::vector<Candidate> propose(glm::dvec2 low,
                               glm::dvec2 high,
                               std::span<const Box> vegetation,
                               const Surroundings& surroundings,
                               const Settings& settings) {
    std::vector<Candidate> candidates;
    std::vector<ColumnHit> hits;
    const std::uint32_t ground_stride = lattice_stride(ground_lattice_m, settings.min_distance_m);
    visit_columns(ground_lattice_m, low, high, [&](const Column& column) {
        propose_on_ground(column, surroundings, ground_stride, hits, candidates);
    });
    const std::uint32_t vegetation_stride = lattice_stride(vegetation_lattice_m, settings.min_distance_m);
    visit_columns(vegetation_lattice_m, low, high, [&](const Column& column) {
        propose_on_vegetation(column, vegetation, vegetation_stride, candidates);
    });
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.priority() < b.priority();
    });
    return candidates;
}

}  // namespace drtv::placement
