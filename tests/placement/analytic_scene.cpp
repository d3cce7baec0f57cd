#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace drtv::test {

void AnalyticScene::column(glm::vec2 at, std::vector<ColumnHit>& hits) const {
    hits.clear();
    floors(at, hits);
    for (const Box& box : boxes) {
        if (at.x < box.low.x || at.x > box.high.x || at.y < box.low.y || at.y > box.high.y)
            continue;
        hits.push_back({box.high.z, true, false});
        hits.push_back({box.low.z, false, true});
    }
    std::stable_sort(hits.begin(), hits.end(),
                     [](const ColumnHit& a, const ColumnHit& b) { return a.z_m > b.z_m; });
}

bool AnalyticScene::is_in_box(const glm::vec3& point) const {
    const auto holds = [&](const Box& box) {
        return glm::all(glm::greaterThan(point, box.low)) && glm::all(glm::lessThan(point, box.high));
    };
    return std::ranges::any_of(boxes, holds) || std::ranges::any_of(solids, holds);
}

std::vector<placement::Side> AnalyticScene::sides(const glm::vec3& from, const glm::vec3& to) const {
    std::vector<placement::Side> sides;
    const double length = glm::length(glm::dvec3(to) - glm::dvec3(from));
    const auto cross = [&](const Box& box) {
        double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
        for (int axis = 0; axis < 3; ++axis) {
            const double o = from[axis], d = (double{to[axis]} - o) / length;
            if (d == 0) {
                if (o <= box.low[axis] || o >= box.high[axis])
                    return;
                continue;
            }
            const double a = (box.low[axis] - o) / d, b = (box.high[axis] - o) / d;
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (leave <= enter)
            return;
        if (enter >= 0 && enter <= length)
            sides.push_back({static_cast<float>(enter), true, false});
        if (leave >= 0 && leave <= length)
            sides.push_back({static_cast<float>(leave), false, false});
    };
    std::ranges::for_each(boxes, cross);
    std::ranges::for_each(solids, cross);
    return sides;
}

placement::SceneQueries AnalyticScene::queries() const {
    placement::SceneQueries queries;
    queries.column = [this](glm::vec2 at, std::vector<ColumnHit>& hits) { column(at, hits); };
    queries.column_of_spaces = queries.column;
    queries.closed_around = [this](const glm::vec3& point) {
        return is_in_box(point) ? std::optional<placement::Thing>(0) : std::nullopt;
    };
    queries.first_met = [](const glm::vec3&, std::span<const placement::Look> looks, std::size_t most) {
        return placement::Met{0, std::min(looks.size(), most), std::nullopt};
    };
    queries.wall_within = [](const glm::vec3&, float) { return std::optional<placement::Thing>(); };
    queries.sides = [this](const glm::vec3& a, const glm::vec3& b) { return sides(a, b); };
    queries.separated = [this](const glm::vec3& a, const glm::vec3& b) { return !sees(a, b); };
    queries.hidden = queries.separated;
    return queries;
}

placement::Placement AnalyticScene::place(std::int32_t i, std::int32_t j, float min_distance_m) const {
    auto placed =
        placement::place_probes({i, j, vegetation, manual, no_probes, spacings}, queries(), {min_distance_m});
    EXPECT_TRUE(placed.has_value()) << placed.error();
    return placed.value_or(placement::Placement{});
}

AnalyticScene flat_ground(float z_m) {
    AnalyticScene scene;
    scene.floors = [z_m](glm::vec2, std::vector<ColumnHit>& hits) { hits.push_back({z_m, true, false}); };
    return scene;
}

std::vector<placement::HandPlacedProbe> manual_at(const std::vector<glm::dvec3>& places) {
    std::vector<placement::HandPlacedProbe> probes;
    for (const glm::dvec3& place : places)
        probes.push_back({place, {}});
    return probes;
}

placement::ClosedVolume box_volume(const glm::dvec3& low, const glm::dvec3& high) {
    std::vector<glm::dvec3> corners;
    for (unsigned n = 0; n < 8; ++n)
        corners.emplace_back((n & 1) != 0 ? high.x : low.x, (n & 2) != 0 ? high.y : low.y,
                             (n & 4) != 0 ? high.z : low.z);
    const std::array<glm::uvec3, 12> triangles = {{{0, 2, 1},
                                                   {1, 2, 3},
                                                   {4, 5, 6},
                                                   {5, 7, 6},
                                                   {0, 1, 4},
                                                   {1, 5, 4},
                                                   {2, 6, 3},
                                                   {3, 6, 7},
                                                   {0, 4, 2},
                                                   {2, 4, 6},
                                                   {1, 3, 5},
                                                   {3, 7, 5}}};
    return placement::ClosedVolume::make(corners, triangles).value();
}

std::int64_t squared_distance(const Position& a, const Position& b) {
    std::int64_t sum = 0;
    for (int axis = 0; axis < 3; ++axis)
        sum += (std::int64_t{a[axis]} - b[axis]) * (std::int64_t{a[axis]} - b[axis]);
    return sum;
}

std::int64_t squared_units(double distance_m) {
    return std::llround(distance_m * 1024) * std::llround(distance_m * 1024);
}

std::int64_t min_squared_distance(std::span<const PlacedProbe> probes) {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (std::size_t a = 0; a < probes.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            if (probes[a].kind == Kind::manual && probes[b].kind == Kind::manual)
                continue;
            least = std::min(least, squared_distance(probes[a].position, probes[b].position));
        }
    }
    return least;
}

std::size_t count_of(const placement::Placement& placement, Kind kind) {
    return static_cast<std::size_t>(std::count_if(placement.probes.begin(), placement.probes.end(),
                                                  [kind](const PlacedProbe& p) { return p.kind == kind; }));
}

std::vector<ProbeKey> keys(std::span<const PlacedProbe> probes) {
    std::vector<ProbeKey> result;
    for (const PlacedProbe& p : probes)
        result.emplace_back(p.position.y, p.position.x, p.position.z, static_cast<int>(p.kind));
    return result;
}

std::vector<ProbeKey> sorted_keys(std::span<const PlacedProbe> probes) {
    std::vector<ProbeKey> result = keys(probes);
    std::sort(result.begin(), result.end());
    return result;
}

}  // namespace drtv::test
