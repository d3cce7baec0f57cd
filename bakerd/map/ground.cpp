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
// Triangle-against-sector tests; far above any real map, it bounds the time a hostile one takes.
constexpr std::size_t max_tests = std::size_t{1} << 28;

using Corner = glm::dvec2;

// Separating axis test of a triangle's plan against a square, touching counts.
bool overlaps_square(const std::array<Corner, 3>& triangle, Corner low, Corner high) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Corner a = triangle[k], edge = triangle[(k + 1) % 3] - a;
        const Corner normal{edge.y, -edge.x};
        const double side_of_third = glm::dot(triangle[(k + 2) % 3] - a, normal);
        if (side_of_third == 0) continue;
        // The square's corner farthest to the side of the third vertex.
        const Corner toward = side_of_third > 0 ? normal : -normal;
        const Corner far{toward.x > 0 ? high.x : low.x, toward.y > 0 ? high.y : low.y};
        if (glm::dot(far - a, toward) < 0) return false;
    }
    return true;
}

SectorCoordinate sector_of(double x_m, double y_m) {
    return {static_cast<std::int32_t>(std::floor(x_m / sector_size_m)), static_cast<std::int32_t>(std::floor(y_m / sector_size_m))};
}

void add_triangle(const std::array<Corner, 3>& triangle, std::set<SectorCoordinate>& found, std::size_t& tests) {
    Corner low = triangle[0], high = triangle[0];
    for (const Corner& corner : triangle) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const SectorCoordinate first = sector_of(low.x, low.y), last = sector_of(high.x, high.y);
    for (std::int32_t j = first.j; j <= last.j; ++j) {
        for (std::int32_t i = first.i; i <= last.i && tests < max_tests; ++i) {
            ++tests;
            if (found.contains({i, j})) continue;
            const Corner corner{i * sector_size_m, j * sector_size_m};
            // A sector is half open: a surface that ends on its western or southern border is not in it.
            if (high.x <= corner.x && low.x < corner.x) continue;
            if (high.y <= corner.y && low.y < corner.y) continue;
            if (overlaps_square(triangle, corner, corner + sector_size_m)) found.insert({i, j});
        }
    }
}

}  // namespace

tl::expected<std::vector<SectorCoordinate>, std::string> sectors_with_ground(const Map& map) {
    std::set<SectorCoordinate> found;
    std::size_t tests = 0;
    for (const Object& object : map.objects) {
        if (object.role != Role::fixed || object.bounds.empty()) continue;
        const glm::vec3 low = object.bounds.low, high = object.bounds.high;
        const double limit_m = max_coordinate * sector_size_m;
        if (low.x < -limit_m || low.y < -limit_m || high.x >= limit_m || high.y >= limit_m) {
            return tl::unexpected(fmt::format("object '{}' spans x {} to {} m, y {} to {} m, beyond the limit of {} m", object.name, low.x, high.x, low.y, high.y, limit_m));
        }
        if (low.z < -max_height_m || high.z > max_height_m) {
            return tl::unexpected(fmt::format("object '{}' spans heights {} to {} m, beyond the limit of {} m", object.name, low.z, high.z, max_height_m));
        }
        const SectorCoordinate first = sector_of(low.x, low.y), last = sector_of(high.x, high.y);
        const auto covered = static_cast<std::size_t>(last.i - first.i + 1) * static_cast<std::size_t>(last.j - first.j + 1);
        if (covered > max_sectors) {
            return tl::unexpected(fmt::format("object '{}' covers {} sectors, over the limit of {}", object.name, covered, max_sectors));
        }
        if (covered == 1) {
            found.insert(first);
            continue;
        }
        for (const Primitive& primitive : map.meshes[object.mesh].primitives) {
            for (const glm::uvec3& t : primitive.triangles) {
                std::array<Corner, 3> triangle;
                for (int k = 0; k < 3; ++k) {
                    triangle[static_cast<std::size_t>(k)] = Corner(object.world_from_object * glm::vec4(primitive.positions[t[k]], 1));
                }
                add_triangle(triangle, found, tests);
            }
        }
        if (found.size() > max_sectors || tests >= max_tests) {
            return tl::unexpected(fmt::format("the map covers more than {} sectors", max_sectors));
        }
    }
    std::vector<SectorCoordinate> sectors(found.begin(), found.end());
    std::sort(sectors.begin(), sectors.end(), [](const SectorCoordinate& a, const SectorCoordinate& b) { return std::pair(a.j, a.i) < std::pair(b.j, b.i); });
    return sectors;
}

}  // namespace drtv::map
