#include "bakerd/map/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace drtv::map {
namespace {

constexpr double max_coordinate = 16384;
constexpr std::size_t max_sectors = std::size_t{1} << 20;
// Triangle-against-sector tests of triangles that span more than a few sectors. Far above any real map, it
// bounds the time a hostile one takes.
constexpr std::size_t max_tests = std::size_t{1} << 26, few_sectors = 16;

using Corner = glm::dvec2;

// Separating axis test of a triangle's plan against a square, touching counts.
bool overlaps_square(const std::array<Corner, 3>& triangle, Corner low, Corner high) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Corner a = triangle[k], edge = triangle[(k + 1) % 3] - a;
        const Corner normal{edge.y, -edge.x};
        const double side_of_third = glm::dot(triangle[(k + 2) % 3] - a, normal);
        // How far the square reaches to both sides of the edge's line.
        const Corner reach{normal.x > 0 ? high.x : low.x, normal.y > 0 ? high.y : low.y},
            other{normal.x > 0 ? low.x : high.x, normal.y > 0 ? low.y : high.y};
        if (side_of_third >= 0 && glm::dot(reach - a, normal) < 0)
            return false;
        if (side_of_third <= 0 && glm::dot(other - a, normal) > 0)
            return false;
    }
    return true;
}

SectorCoordinate sector_of(double x_m, double y_m) {
    return {static_cast<std::int32_t>(std::floor(x_m / sector_size_m)),
            static_cast<std::int32_t>(std::floor(y_m / sector_size_m))};
}

std::size_t covered(SectorCoordinate first, SectorCoordinate last) {
    return static_cast<std::size_t>(last.i - first.i + 1) * static_cast<std::size_t>(last.j - first.j + 1);
}

// The sectors that an object's bounds span, and which of them its triangles reach.
struct Span {
    SectorCoordinate first, last;
    std::vector<bool> reached;
    std::size_t missing;

    Span(SectorCoordinate low, SectorCoordinate high)
        : first(low), last(high), reached(covered(low, high), false), missing(reached.size()) {}

    [[nodiscard]] std::size_t at(std::int32_t i, std::int32_t j) const {
        return static_cast<std::size_t>(j - first.j) * static_cast<std::size_t>(last.i - first.i + 1) +
               static_cast<std::size_t>(i - first.i);
    }
};

// REQUIRES: the triangle lies in the span.
void add_triangle(const std::array<Corner, 3>& triangle, Span& span, std::size_t& tests) {
    Corner low = triangle[0], high = triangle[0];
    for (const Corner& corner : triangle) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const SectorCoordinate first = sector_of(low.x, low.y), last = sector_of(high.x, high.y);
    if (covered(first, last) > few_sectors)
        tests += covered(first, last);
    for (std::int32_t j = first.j; j <= last.j; ++j) {
        for (std::int32_t i = first.i; i <= last.i; ++i) {
            const std::size_t at = span.at(i, j);
            if (span.reached[at])
                continue;
            const Corner corner{i * sector_size_m, j * sector_size_m};
            // A sector is half open: a surface that ends on its western or southern border is not in it.
            if (high.x <= corner.x && low.x < corner.x)
                continue;
            if (high.y <= corner.y && low.y < corner.y)
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
            std::array<Corner, 3> triangle;
            for (int k = 0; k < 3; ++k) {
                triangle[static_cast<std::size_t>(k)] =
                    Corner(object.world_from_object * glm::vec4(primitive.positions[t[k]], 1));
            }
            add_triangle(triangle, span, tests);
        }
    }
    return true;
}

}  // namespace

tl::expected<std::vector<SectorCoordinate>, std::string> sectors_with_ground(const Map& map) {
    std::set<SectorCoordinate> found;
    std::size_t tests = 0;
    for (const Object& object : map.objects) {
        if (object.role != Role::fixed || object.bounds.empty())
            continue;
        const glm::vec3 low = object.bounds.low, high = object.bounds.high;
        const double limit_m = max_coordinate * sector_size_m;
        if (low.x < -limit_m || low.y < -limit_m || high.x >= limit_m || high.y >= limit_m) {
            return tl::unexpected(
                fmt::format("object '{}' spans x {} to {} m, y {} to {} m, beyond the limit of {} m",
                            object.name,
                            low.x,
                            high.x,
                            low.y,
                            high.y,
                            limit_m));
        }
        if (low.z < -max_height_m || high.z > max_height_m) {
            return tl::unexpected(
                fmt::format("object '{}' spans heights {} to {} m, beyond the limit of {} m",
                            object.name,
                            low.z,
                            high.z,
                            max_height_m));
        }
        const SectorCoordinate first = sector_of(low.x, low.y), last = sector_of(high.x, high.y);
        const std::size_t sectors = covered(first, last);
        if (sectors > max_sectors) {
            return tl::unexpected(fmt::format(
                "object '{}' covers {} sectors, over the limit of {}", object.name, sectors, max_sectors));
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
        for (std::int32_t j = first.j; j <= last.j; ++j) {
            for (std::int32_t i = first.i; i <= last.i; ++i) {
                if (span.reached[span.at(i, j)])
                    found.insert({i, j});
            }
        }
        if (found.size() > max_sectors)
            return tl::unexpected(fmt::format("the map covers more than {} sectors", max_sectors));
    }
    std::vector<SectorCoordinate> sectors(found.begin(), found.end());
    std::sort(sectors.begin(), sectors.end(), [](const SectorCoordinate& a, const SectorCoordinate& b) {
        return std::pair(a.j, a.i) < std::pair(b.j, b.i);
    });
    return sectors;
}

}  // namespace drtv::map
