// What stands where: columns, solids, sight between places, and the nearest surface.
#include "bakerd/trace/query.h"
#include "bakerd/trace/scene.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace drtv::trace {
namespace {

bool holds(const map::Bounds& outer, const map::Bounds& inner) {
    return glm::all(glm::lessThanEqual(outer.low, inner.low)) &&
           glm::all(glm::greaterThanEqual(outer.high, inner.high));
}

// In the world, however the object is turned.
double volume_of(const map::Bounds& bounds, const glm::mat4x3& world_from_object) {
    const glm::dvec3 size(bounds.high - bounds.low);
    return size.x * size.y * size.z * std::abs(glm::determinant(glm::dmat3(world_from_object)));
}

}  // namespace

void Scene::column(glm::vec2 at, std::vector<placement::ColumnHit>& hits) const {
    column(at, glm::vec3(0, 0, -1), Collected::of_static, hits);
}

void Scene::column_of_spaces(glm::vec2 at, std::vector<placement::ColumnHit>& hits) const {
    // Of a line along an axis four are asked (Sides), which is not worth it here.
    column(at, glm::vec3(0x1p-19f, 0x1.8p-20f, -1), Collected::of_spaces, hits);
}

void Scene::column(glm::vec2 at,
                   const glm::vec3& down,
                   Collected wanted,
                   std::vector<placement::ColumnHit>& hits) const {
    hits.clear();
    // The line's ends are constants: were they taken from the scene, its rounding would depend on far
    // objects.
    const Ray line{glm::vec3(at, map::max_height_m), down, 2 * map::max_height_m};
    for (const Crossing& crossing : all_crossings(line, wanted)) {
        const TriangleSet& set = set_of(crossing.id.instance, crossing.id.set);
        const std::optional<double> z_m =
            height_at(trace::transformed(world_from_object(crossing.id.instance),
                                         corners_of(set, crossing.id.triangle)),
                      at);
        if (!z_m)
            continue;
        const bool body = set.is_of_body(crossing.id.triangle);
        const bool two_sided = is_two_sided(*set.material, role_of(crossing.id.instance)) && !body;
        const bool front = meets_front(crossing.id.instance, crossing.at, line);
        hits.push_back({static_cast<float>(*z_m), front || two_sided, !front || two_sided, front, body});
    }
    std::ranges::sort(hits, std::greater());
}

// A closed part on a line, and how often it holds the line's start.
struct Scene::Around {
    std::uint32_t instance;
    std::uint32_t part;
    bool outward;
    double volume;  // of its bounds
    int winding;
};

void Scene::add_around(const Crossing& crossing, bool front, std::vector<Around>& parts) const {
    const TriangleSet& set = set_of(crossing.id.instance, crossing.id.set);
    const std::uint32_t part = set.closed_part_of(crossing.id.triangle);
    const int step = front ? -1 : 1;
    for (Around& known : parts) {
        if (known.instance == crossing.id.instance && known.part == part) {
            known.winding += step;
            return;
        }
    }
    const ClosedPart& closed = set.closed->part(part);
    const double volume = volume_of(closed.bounds, world_from_object(crossing.id.instance));
    parts.push_back({crossing.id.instance, part, closed.outward, volume, step});
}

// Around its own corners: those of its turned box would say nothing of what holds what.
map::Bounds Scene::bounds_of(std::uint32_t instance, std::uint32_t part) const {
    const std::lock_guard lock(part_bounds_mutex_);
    const auto [known, added] = part_bounds_.try_emplace({instance, part});
    if (!added)
        return known->second;
    const map::Mesh& mesh = map_->meshes[map_->objects[object_index(instance)].mesh];
    const ClosedParts& closed = *closed_of(instance);
    const glm::dmat4x3 place(world_from_object(instance));
    for (std::uint32_t n = 0; n < mesh.primitives.size(); ++n) {
        const map::Primitive& primitive = mesh.primitives[n];
        for (std::uint32_t t = 0; t < primitive.triangles.size(); ++t) {
            for (glm::length_t k = 0; closed.part_of(n, t) == part && k < 3; ++k)
                known->second.extend(
                    glm::vec3(place * glm::dvec4(primitive.positions[primitive.triangles[t][k]], 1)));
        }
    }
    return known->second;
}

std::optional<std::uint32_t> Scene::closed_around(const Ray& line) const {
    std::vector<Around> parts;
    for (const Crossing& crossing : all_crossings(line, Collected::closed))
        add_around(crossing, meets_front(crossing.id.instance, crossing.at, line), parts);
    int winding = 0;
    const Around* innermost = nullptr;
    for (const Around& part : parts) {
        if (part.outward) {
            winding += part.winding;
            const bool smaller = innermost == nullptr || part.volume < innermost->volume;
            if (part.winding > 0 && smaller)
                innermost = &part;
            continue;
        }
        const bool is_cavity = std::ranges::any_of(parts, [&](const Around& other) {
            return other.outward && other.winding > 0 &&
                   holds(bounds_of(other.instance, other.part), bounds_of(part.instance, part.part));
        });
        winding += is_cavity ? part.winding : 0;
    }
    if (winding <= 0 || innermost == nullptr)
        return std::nullopt;
    return object_index(innermost->instance);
}

// A line may be counted wrongly at an edge that it meets exactly. Of three two are right.
std::optional<std::uint32_t> Scene::closed_around(const glm::vec3& point) const {
    if (!kinds_.closed)
        return std::nullopt;
    // Not along an axis, for Sides; so steep that they stay within a scene that is cut to its region.
    const std::array<glm::vec3, 3> up = {
        {{0x1.9p-12f, 0x1.1p-12f, 1}, {-0x1.5p-12f, 0x1.7p-13f, 1}, {0x1.3p-13f, -0x1.bp-12f, 1}}};
    constexpr float far_m = 2 * map::max_height_m;
    const auto first = closed_around(Ray{point, up[0], far_m});
    const auto second = closed_around(Ray{point, up[1], far_m});
    if (first.has_value() == second.has_value())
        return first;
    return closed_around(Ray{point, up[2], far_m}) ? (first ? first : second) : std::nullopt;
}

std::vector<placement::Side> Scene::sides_met(const Ray& ray) const {
    std::vector<placement::Side> sides;
    for (const Crossing& crossing : all_crossings(ray, Collected::of_spaces)) {
        const TriangleSet& set = set_of(crossing.id.instance, crossing.id.set);
        sides.push_back({static_cast<float>(crossing.at.distance_m),
                         meets_front(crossing.id.instance, crossing.at, ray),
                         is_two_sided(*set.material, role_of(crossing.id.instance)) &&
                             !set.is_of_body(crossing.id.triangle)});
    }
    return sides;
}

bool Scene::separated(const Ray& ray) const {
    Query query(*this, {&ray, 1});
    query.to_separate = true;
    return is_met(query, ray);
}

struct Scene::Nearest {
    float distance_m;
    std::optional<std::uint32_t> instance;
};

// At most `max_m` away.
Scene::Nearest Scene::nearest_surface(const glm::vec3& point, float max_m, bool only_walls) const {
    struct Search {
        const Scene& scene;
        Ray from;  // for its start
        glm::dvec3 point;
        bool only_walls;
        Nearest nearest;
    };
    Search search{*this, {point, {}, 0}, point, only_walls, {max_m, std::nullopt}};
    // Embree rounds: of two that are about as near it must offer both.
    RTCPointQuery query{point.x, point.y, point.z, 0, max_m + query_slack(search.from, max_m)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto look = [](RTCPointQueryFunctionArguments* found) {
        auto& [scene, from, at, walls, nearest] = *static_cast<Search*>(found->userPtr);
        std::uint32_t instance = found->context->instID[0];
        if (found->context->instStackSize == 0)
            instance = scene.world_sets_[found->geomID - scene.map_->objects.size()]->instance;
        else if (scene.instances_[instance].mesh->is_margin(found->geomID))
            return false;
        const TriangleSet& set = scene.set_of(instance, found->geomID);
        if (walls && scene.role_of(instance) == map::Role::vegetation &&
            set.closed_part_of(found->primID) == ClosedParts::none)
            return false;
        const auto distance_m = static_cast<float>(distance_to(
            trace::transformed(scene.world_from_object(instance), corners_of(set, found->primID)), at));
        const bool is_first =
            distance_m == nearest.distance_m && nearest.instance && instance < *nearest.instance;
        if (!(distance_m < nearest.distance_m) && !is_first)
            return false;
        nearest = {distance_m, instance};
        found->query->radius = distance_m + query_slack(from, distance_m);
        return true;
    };
    rtcPointQuery(handle_, &query, &context, look, &search);
    return search.nearest;
}

float Scene::distance_to_surface(const glm::vec3& point, float max_m) const {
    return nearest_surface(point, max_m, false).distance_m;
}

std::optional<std::uint32_t> Scene::wall_within(const glm::vec3& point, float max_m) const {
    const Nearest nearest = nearest_surface(point, max_m, true);
    return nearest.instance ? std::optional(object_index(*nearest.instance)) : std::nullopt;
}

}  // namespace drtv::trace
