#include "bakerd/bake/placement_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace drtv::bake {
namespace {

void store_hits(const std::vector<trace::ColumnHit>& found, std::vector<placement::ColumnHit>& hits) {
    hits.clear();
    for (const trace::ColumnHit& hit : found)
        hits.push_back({hit.z_m, hit.up_facing, hit.down_facing, hit.wound_up, hit.body});
}

}  // namespace

placement::Surroundings surroundings_of(const trace::Scene& scene, float reach_m) {
    const auto between = [](const glm::vec3& from, const glm::vec3& to) {
        const float distance_m = glm::length(to - from);
        return trace::Ray{from, (to - from) / distance_m, distance_m};
    };
    placement::Surroundings surroundings;
    surroundings.column = [&scene](glm::vec2 at, std::vector<placement::ColumnHit>& hits) {
        std::vector<trace::ColumnHit> found;
        scene.column(at, found);
        store_hits(found, hits);
    };
    surroundings.column_of_spaces = [&scene](glm::vec2 at, std::vector<placement::ColumnHit>& hits) {
        std::vector<trace::ColumnHit> found;
        scene.column_of_spaces(at, found);
        store_hits(found, hits);
    };
    surroundings.closed_around = [&scene](const glm::vec3& point) { return scene.closed_around(point); };
    surroundings.first_met = [&scene, reach_m](const glm::vec3& origin,
                                               std::span<const placement::Look> looks,
                                               std::size_t most_misses) {
        placement::Met met;
        std::map<std::uint32_t, std::size_t> behind;
        for (const placement::Look& look : looks) {
            const auto hit = scene.closest({origin, look.direction, std::min(look.far_m, reach_m)});
            met.misses += hit ? 0u : 1u;
            if (met.misses == most_misses)
                break;
            if (!hit || hit->front)
                continue;
            ++met.backs;
            ++behind[scene.object_index(hit->instance)];
        }
        if (!behind.empty())
            met.behind =
                std::ranges::max_element(behind, {}, [](const auto& entry) { return entry.second; })->first;
        return met;
    };
    surroundings.wall_within = [&scene](const glm::vec3& point, float within_m) {
        return scene.wall_within(point, within_m);
    };
    surroundings.sides = [&scene, between](const glm::vec3& from, const glm::vec3& to) {
        std::vector<placement::Side> sides;
        for (const trace::SideHit& hit : scene.sides_met(between(from, to)))
            sides.push_back({hit.distance_m, hit.front, hit.sheet});
        return sides;
    };
    surroundings.separated = [&scene, between](const glm::vec3& from, const glm::vec3& to) {
        return from != to && scene.separated(between(from, to));
    };
    surroundings.hidden = [&scene, between](const glm::vec3& from, const glm::vec3& to) {
        return from != to && scene.occluded(between(from, to));
    };
    return surroundings;
}

}  // namespace drtv::bake
