#include "bakerd/map/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace drtv::map {
namespace {

constexpr double max_coordinate = 16384;
constexpr std::size_t max_sectors = std::size_t{1} << 20;
// Triangle-against-sector tests of triangles that span more than a few sectors. Far above any real map, it
// bounds the time a hostile one takes.
constexpr std::size_t max_tests = std::size_t{1} << 26;
constexpr std::size_t few_sectors = 16;

using Corner = glm::dvec2;

// Separating axis test of a triangle's plan against a square, touching counts.
bool overlaps_square(const std::array<Corner, 3>& triangle, Corner low, Corner high) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Corner a = triangle[k];
        const Corner edge = triangle[(k + 1) % 3] - a;
        const Corner third = triangle[(k + 2) % 3] - a;
        const Corner normal{edge.y, -edge.x};
        const double side_of_third = glm::dot(third, normal);
        // How far the square reaches to both sides of the edge's line.
        const bool to_east = normal.x > 0;
        const bool to_north = normal.y > 0;
        const Corner reach{to_east ? high.x : low.x, to_north ? high.y : low.y};
        const Corner other{to_east ? low.x : high.x, to_north ? low.y : high.y};
        if (side_of_third >= 0 && glm::dot(reach - a, normal) < 0)
            return false;
        if (side_of_third <= 0 && glm::dot(other - a, normal) > 0)
            return false;
    }
    return true;
}

SectorCoordinate sector_of(double x_m, double y_m) {
    const double i = std::floor(x_m / sector_size_m);
    const double j = std::floor(y_m / sector_size_m);
    return {static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)};
}

// As it is placed, in whole units.
SectorCoordinate sector_holding(const ProbeNode& probe) {
    const auto rounded = [](double m) { return std::round(m * position_units_per_m) / position_units_per_m; };
    return sector_of(rounded(probe.position.x), rounded(probe.position.y));
}

std::size_t covered(SectorCoordinate first, SectorCoordinate last) {
    const auto columns = static_cast<std::size_t>(last.i - first.i + 1);
    const auto rows = static_cast<std::size_t>(last.j - first.j + 1);
    return columns * rows;
}

// The sectors that an object's bounds span, and which of them its triangles reach.
struct Span {
    SectorCoordinate first;
    SectorCoordinate last;
    std::vector<bool> reached;
    std::size_t missing;

    Span(SectorCoordinate low, SectorCoordinate high)
        : first(low), last(high), reached(covered(low, high), false), missing(reached.size()) {}

    [[nodiscard]] std::size_t at(std::int32_t i, std::int32_t j) const {
        const auto columns = static_cast<std::size_t>(last.i - first.i + 1);
        const auto column = static_cast<std::size_t>(i - first.i);
        const auto row = static_cast<std::size_t>(j - first.j);
        return row * columns + column;
    }
};

// Along one axis, whether a surface from `low` to `high` ends at the border of the sector that begins at
// `corner`, or goes over it by less than rounding. A sector is half open: what stands on its border is in it.
bool only_touches(double low, double high, double corner) {
    const double slack = 0x1p-10 + std::abs(corner) * 0x1p-20;
    const double end = corner + sector_size_m;
    return (low < corner - slack && high <= corner + slack) || (low >= end - slack && high > end + slack);
}

// REQUIRES: the triangle lies in the span.
void add_triangle(const std::array<Corner, 3>& triangle, Span& span, std::size_t& tests) {
    Corner low = triangle[0];
    Corner high = triangle[0];
    for (const Corner& corner : triangle) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const SectorCoordinate first = sector_of(low.x, low.y);
    const SectorCoordinate last = sector_of(high.x, high.y);
    if (covered(first, last) > few_sectors)
        tests += covered(first, last);
    for (std::int32_t j = first.j; j <= last.j; ++j) {
        for (std::int32_t i = first.i; i <= last.i; ++i) {
            const std::size_t at = span.at(i, j);
            if (span.reached[at])
                continue;
            const Corner corner{i * sector_size_m, j * sector_size_m};
            if (only_touches(low.x, high.x, corner.x) || only_touches(low.y, high.y, corner.y))
                continue;
            if (!overlaps_square(triangle, corner, corner + sector_size_m))
                continue;
            span.reached[at] = true;
            --span.missing;
        }
    }
}

// Adds the sectors that the object's triangles reach; false when that takes more than max_tests tests.
bool add_object(const Map& map, const Object& object, Span& span, std::size_t& tests) {
    if (span.missing > few_sectors)
        tests += span.missing;
    for (const Primitive& primitive : map.meshes[object.mesh].primitives) {
        for (const glm::uvec3& t : primitive.triangles) {
            if (span.missing == 0)
                return true;
            if (tests >= max_tests)
                return false;
            const auto corner = [&](std::uint32_t vertex) {
                return Corner(object.world_from_object * glm::vec4(primitive.positions[vertex], 1));
            };
            add_triangle({corner(t.x), corner(t.y), corner(t.z)}, span, tests);
        }
    }
    return true;
}

// Nothing, or a sentence on an object that lies too far out.
std::optional<std::string> range_problem(const Object& object) {
    const glm::vec3 low = object.bounds.low;
    const glm::vec3 high = object.bounds.high;
    constexpr double limit_m = max_coordinate * sector_size_m;
    if (low.x < -limit_m || low.y < -limit_m || high.x >= limit_m || high.y >= limit_m) {
        return fmt::format("object '{}' spans x {} to {} m, y {} to {} m, beyond the limit of {} m",
                           object.name,
                           low.x,
                           high.x,
                           low.y,
                           high.y,
                           limit_m);
    }
    if (low.z < -max_height_m || high.z > max_height_m) {
        return fmt::format("object '{}' spans heights {} to {} m, beyond the limit of {} m",
                           object.name,
                           low.z,
                           high.z,
                           max_height_m);
    }
    return {};
}

void insert_reached(const Span& span, std::set<SectorCoordinate>& found) {
    for (std::int32_t j = span.first.j; j <= span.last.j; ++j) {
        for (std::int32_t i = span.first.i; i <= span.last.i; ++i) {
            if (span.reached[span.at(i, j)])
                found.insert({i, j});
        }
    }
}

}  // namespace

tl::expected<std::vector<SectorCoordinate>, std::string> sectors_of(const Map& map) {
    std::set<SectorCoordinate> found;
    std::size_t tests = 0;
    for (const Object& object : map.objects) {
        if (object.role != Role::fixed || object.bounds.empty())
            continue;
        if (const auto problem = range_problem(object))
            return tl::unexpected(*problem);
        const SectorCoordinate first = sector_of(object.bounds.low.x, object.bounds.low.y);
        const SectorCoordinate last = sector_of(object.bounds.high.x, object.bounds.high.y);
        const std::size_t sectors = covered(first, last);
        if (sectors > max_sectors) {
            return tl::unexpected(
                fmt::format("object '{}' is {:.4g} km x {:.4g} km and covers {} sectors of 64 m, over the "
                            "limit of {}: was the "
                            "map made in metres?",
                            object.name,
                            (object.bounds.high.x - object.bounds.low.x) / 1000,
                            (object.bounds.high.y - object.bounds.low.y) / 1000,
                            sectors,
                            max_sectors));
        }
        if (sectors == 1) {
            found.insert(first);
            continue;
        }
        Span span(first, last);
        if (!add_object(map, object, span, tests)) {
            return tl::unexpected(fmt::format(
                "object '{}' and those before it take more than {} tests of a triangle against a sector",
                object.name,
                max_tests));
        }
        insert_reached(span, found);
        if (found.size() > max_sectors)
            break;
    }
    for (const ProbeNode& probe : map.probes)
        found.insert(sector_holding(probe));
    if (found.size() > max_sectors)
        return tl::unexpected(fmt::format("the map covers more than {} sectors", max_sectors));
    std::vector<SectorCoordinate> sectors(found.begin(), found.end());
    std::ranges::sort(sectors, [](const SectorCoordinate& a, const SectorCoordinate& b) {
        return std::pair(a.j, a.i) < std::pair(b.j, b.i);
    });
    return sectors;
}

}  // namespace drtv::map
