#include "bakerd/bake/placement_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace drtv::bake {
placement::SceneQueries queries_of(const trace::Scene& scene, float reach_m) {
    const auto between = [](const glm::vec3& from, const glm::vec3& to) {
        const float distance_m = glm::length(to - from);
        return trace::Ray{from, (to - from) / distance_m, distance_m};
    };
    placement::SceneQueries queries;
    queries.column = [&scene](glm::vec2 at, std::vector<placement::ColumnHit>& hits) {
        scene.column(at, hits);
    };
    queries.column_of_spaces = [&scene](glm::vec2 at, std::vector<placement::ColumnHit>& hits) {
        scene.column_of_spaces(at, hits);
    };
    queries.closed_around = [&scene](const glm::vec3& point) { return scene.closed_around(point); };
    queries.first_met = [&scene, reach_m](const glm::vec3& origin,
                                          std::span<const placement::Look> looks,
                                          std::size_t max_misses) {
        placement::Met met;
        std::map<std::uint32_t, std::size_t> behind;
        for (const placement::Look& look : looks) {
            const auto hit = scene.closest({origin, look.direction, std::min(look.far_m, reach_m)});
            met.misses += hit ? 0u : 1u;
            if (met.misses == max_misses)
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
    queries.wall_within = [&scene](const glm::vec3& point, float within_m) {
        return scene.wall_within(point, within_m);
    };
    queries.sides = [&scene, between](const glm::vec3& from, const glm::vec3& to) {
        return scene.sides_met(between(from, to));
    };
    queries.separated = [&scene, between](const glm::vec3& from, const glm::vec3& to) {
        return from != to && scene.separated(between(from, to));
    };
    queries.hidden = [&scene, between](const glm::vec3& from, const glm::vec3& to) {
        return from != to && scene.occluded(between(from, to));
    };
    return queries;
}

}  // namespace drtv::bake
