#include "bakerd/trace/scene.h"

#include "bakerd/trace/query.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace drtv::trace {
namespace {

bool overlaps(const map::Bounds& bounds, const Region& region, float margin_m) {
    return bounds.low.x <= region.high.x + margin_m && bounds.high.x >= region.low.x - margin_m && bounds.low.y <= region.high.y + margin_m &&
           bounds.high.y >= region.low.y - margin_m;
}

bool mirrors(const glm::mat4x3& world_from_object) {
    const glm::dvec3 x(world_from_object[0]), y(world_from_object[1]), z(world_from_object[2]);
    return glm::dot(glm::cross(x, y), z) < 0;
}

// Terrain and the like is cut to what lies within reach and put into world space: its memory follows the reach too, and
// rays near it need no transform. It must depend on the object alone: a hit's last digits are not the same either way.
bool is_large(const map::Bounds& bounds) {
    constexpr float side_m = 96;
    return std::max(bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y) > side_m;
}

// In double: a cofactor matrix, which needs no division and keeps the side even where the map mirrors.
glm::mat3 normal_transform(const glm::mat4x3& world_from_object) {
    const glm::dvec3 x(world_from_object[0]), y(world_from_object[1]), z(world_from_object[2]);
    const double sign = mirrors(world_from_object) ? -1 : 1;
    return glm::mat3(glm::dmat3(glm::cross(y, z) * sign, glm::cross(z, x) * sign, glm::cross(x, y) * sign));
}

std::array<glm::dvec3, 3> world_corners(const map::Object& object, const map::Primitive& primitive, std::uint32_t triangle) {
    const glm::uvec3& t = primitive.triangles[triangle];
    const glm::dmat4x3 world_from_object(object.world_from_object);
    const auto corner = [&](std::uint32_t vertex) { return world_from_object * glm::dvec4(primitive.positions[vertex], 1); };
    return {corner(t.x), corner(t.y), corner(t.z)};
}

// Height of the triangle's plane at a point inside its plan, from its vertices alone: the distance along a line
// of kilometres would have lost the digits. Nothing for a vertical triangle.
std::optional<double> height_on_triangle(const map::Object& object, const map::Primitive& primitive, std::uint32_t triangle, glm::vec2 at) {
    const auto [a, b, c] = world_corners(object, primitive, triangle);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (std::abs(normal.z) <= 1e-6 * glm::length(normal)) return std::nullopt;
    const double z_m = a.z - (normal.x * (double{at.x} - a.x) + normal.y * (double{at.y} - a.y)) / normal.z;
    return std::clamp(z_m, std::min({a.z, b.z, c.z}), std::max({a.z, b.z, c.z}));
}

// From a point to the nearest one of a triangle (Ericson, Real-Time Collision Detection, 5.1.5: by the regions of its corners, edges and face).
double distance_to_triangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp), d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return glm::length(ap);
    if (d3 >= 0 && d4 <= d3) return glm::length(bp);
    if (d6 >= 0 && d5 <= d6) return glm::length(cp);
    const double of_a = d3 * d6 - d5 * d4, of_b = d5 * d2 - d1 * d6, of_c = d1 * d4 - d3 * d2;
    if (of_c <= 0 && d1 >= 0 && d3 <= 0) return glm::length(ap - ab * (d1 / (d1 - d3)));
    if (of_b <= 0 && d2 >= 0 && d6 <= 0) return glm::length(ap - ac * (d2 / (d2 - d6)));
    if (of_a <= 0 && d4 >= d3 && d5 >= d6) return glm::length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    return glm::length(ap - (ab * of_b + ac * of_c) / (of_a + of_b + of_c));
}

// The back of a triangle that has a twin is the twin's front: which of the two the ray met first is rounding.
void turn_to_twin(const TriangleSet::Twin& twin, Hit& hit) {
    const std::array<float, 3> weights = {1 - hit.u - hit.v, hit.u, hit.v};
    std::array<float, 3> of_twin{};
    of_twin[twin.first] = weights[0];
    of_twin[(twin.first + 2u) % 3] = weights[1];
    of_twin[(twin.first + 1u) % 3] = weights[2];
    hit.primitive = twin.primitive;
    hit.triangle = twin.triangle;
    hit.u = of_twin[1];
    hit.v = of_twin[2];
    hit.front = true;
}

RTCRayHit embree_ray_hit(const Ray& ray) {
    RTCRayHit r{};
    r.ray = embree_ray(ray);
    r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return r;
}

// Every triangle that the ray meets, once, in the order of their ids.
std::vector<Crossing> collect_crossings(RTCScene scene, const Ray& ray) {
    std::vector<Crossing> crossings;
    Query query;
    query.crossings = &crossings;
    RTCRayHit r = embree_ray_hit(ray);
    rtcIntersect1(scene, &query.base, &r);
    std::ranges::sort(crossings, {}, &Crossing::id);
    const auto again = std::ranges::unique(crossings, {}, &Crossing::id);
    crossings.erase(again.begin(), again.end());
    return crossings;
}

}  // namespace

std::shared_ptr<const Scene> Scene::build(MapGeometry& geometry, const Region& region, float reach_m) {
    std::shared_ptr<Scene> scene(new Scene);
    scene->device_ = geometry.device();
    scene->map_ = geometry.map();
    scene->handle_ = rtcNewScene(scene->device_->handle());
    rtcSetSceneFlags(scene->handle_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene->handle_, RTC_BUILD_QUALITY_MEDIUM);
    std::vector<std::shared_ptr<const MeshBvh>> by_mesh(scene->map_->meshes.size());
    const std::vector<map::Object>& objects = scene->map_->objects;
    for (std::uint32_t n = 0; n < objects.size(); ++n) {
        const map::Object& object = objects[n];
        if (!overlaps(object.bounds, region, reach_m)) continue;
        scene->bounds_.extend(object.bounds.low);
        scene->bounds_.extend(object.bounds.high);
        if (is_large(object.bounds)) {
            scene->add_large(n, region, reach_m);
            continue;
        }
        std::shared_ptr<const MeshBvh>& bvh = by_mesh[object.mesh];
        if (!bvh) bvh = geometry.bvh_of(object.mesh);
        scene->add_instance(n, *bvh);
    }
    rtcCommitScene(scene->handle_);
    for (auto& bvh : by_mesh) {
        if (bvh) scene->meshes_.push_back(std::move(bvh));
    }
    return scene;
}

void Scene::add_instance(std::uint32_t object, const MeshBvh& bvh) {
    const glm::mat4x3& world_from_object = map_->objects[object].world_from_object;
    RTCGeometry instance = rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, bvh.handle());
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &world_from_object[0][0]);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(handle_, instance, static_cast<unsigned>(instances_.size()));
    rtcReleaseGeometry(instance);
    instances_.push_back({object, &bvh, normal_transform(world_from_object)});
}

void Scene::add_large(std::uint32_t object, const Region& region, float reach_m) {
    const map::Object& placed = map_->objects[object];
    const glm::dmat4x3 world_from_object(placed.world_from_object);
    const auto within_reach = [&](const map::Primitive& primitive, const glm::uvec3& triangle) {
        map::Bounds bounds;
        for (glm::length_t k = 0; k < 3; ++k) bounds.extend(glm::vec3(world_from_object * glm::dvec4(primitive.positions[triangle[k]], 1)));
        return overlaps(bounds, region, reach_m);
    };
    const bool mirrored = mirrors(placed.world_from_object);
    for (auto& set : triangle_sets(*map_, map_->meshes[placed.mesh], within_reach)) {
        set->instance = static_cast<std::uint32_t>(instances_.size());
        set->mirrored = mirrored;
        attach(device_->handle(), handle_, *set, static_cast<std::uint32_t>(map_->objects.size() + large_sets_.size()), placed.world_from_object);
        large_sets_.push_back(std::move(set));
    }
    instances_.push_back({object, nullptr, glm::mat3(mirrored ? -1.0f : 1.0f)});
}

const TriangleSet& Scene::set_of(std::uint32_t instance, std::uint32_t embree_geometry) const {
    const MeshBvh* mesh = instances_[instance].mesh;
    return mesh != nullptr ? mesh->set(embree_geometry) : *large_sets_[embree_geometry - map_->objects.size()];
}

Scene::~Scene() {
    if (handle_ != nullptr) rtcReleaseScene(handle_);
}

std::optional<Hit> Scene::closest(const Ray& ray) const {
    Query query;
    RTCRayHit r = embree_ray_hit(ray);
    rtcIntersect1(handle_, &query.base, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const std::uint32_t instance = query.best.instance;
    const TriangleSet& set = set_of(instance, r.hit.geomID);
    glm::vec3 normal = instances_[instance].world_from_normal * glm::vec3(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z);
    // The front is counter-clockwise in object space; a cofactor transform keeps the sign of direction . normal.
    const bool front = glm::dot(normal, ray.direction) < 0;
    const float length = glm::length(normal);
    normal = length > 0 ? normal * ((front ? 1.0f : -1.0f) / length) : -ray.direction;
    Hit hit{query.best_distance, instance, set.primitive_index, set.triangle_of(r.hit.primID), r.hit.u, r.hit.v, front, normal, length};
    if (!front && !set.twins.empty() && set.twins[r.hit.primID].present()) turn_to_twin(set.twins[r.hit.primID], hit);
    return hit;
}

Ray beside(const Ray& ray) {
    constexpr float breadth = 0x1p-18f;  // radians: 2 mm at 512 m
    const glm::vec3& d = ray.direction;
    const glm::vec3 across = glm::cross(d, std::abs(d.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
    return {ray.origin, glm::normalize(d + across * breadth), ray.far_m};
}

Surface Scene::surface(const Hit& hit, float footprint_m) const {
    const map::Object& object = object_of(hit);
    return surface_at(*map_, map_->meshes[object.mesh].primitives[hit.primitive], object.role, hit.triangle, hit.u, hit.v, hit.front, hit.double_area_m2, footprint_m);
}

void Scene::occluded(std::span<const Ray> rays, std::vector<bool>& answers) const {
    Query query;
    query.base.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    thread_local std::vector<RTCRay> stream;
    stream.clear();
    for (const Ray& ray : rays) stream.push_back(embree_ray(ray));
    rtcOccluded1M(handle_, &query.base, stream.data(), static_cast<unsigned>(stream.size()), sizeof(RTCRay));
    answers.clear();
    for (const RTCRay& ray : stream) answers.push_back(ray.tfar < 0);
}

std::size_t Scene::crossings(const Ray& ray) const {
    const std::vector<Crossing> crossings = collect_crossings(handle_, ray);
    // Twins are one surface.
    std::size_t count = crossings.size();
    for (const Crossing& a : crossings) {
        const TriangleSet& set = set_of(a.id.instance, a.id.set);
        if (set.twins.empty() || !set.twins[a.id.triangle].present()) continue;
        const TriangleSet::Twin& twin = set.twins[a.id.triangle];
        for (const Crossing& b : crossings) {
            const TriangleSet& other = set_of(b.id.instance, b.id.set);
            if (a.id < b.id && a.id.instance == b.id.instance && other.primitive_index == twin.primitive && other.triangle_of(b.id.triangle) == twin.triangle) --count;
        }
    }
    return count;
}

bool Scene::occluded(const Ray& ray) const {
    Query query;
    RTCRay r = embree_ray(ray);
    rtcOccluded1(handle_, &query.base, &r);
    return r.tfar < 0;
}

void Scene::column(glm::vec2 at, std::vector<ColumnHit>& hits) const {
    hits.clear();
    // The line's ends are constants: were they taken from the scene, its rounding would depend on far objects.
    for (const Crossing& crossing : collect_crossings(handle_, {glm::vec3(at, map::max_height_m), glm::vec3(0, 0, -1), 2 * map::max_height_m})) {
        const map::Object& object = map_->objects[object_index(crossing.id.instance)];
        if (object.role == map::Role::vegetation) continue;
        const TriangleSet& set = set_of(crossing.id.instance, crossing.id.set);
        const std::optional<double> z_m = height_on_triangle(object, *set.primitive, set.triangle_of(crossing.id.triangle), at);
        if (!z_m) continue;
        const bool two_sided = is_two_sided(*set.material, object.role);
        hits.push_back({static_cast<float>(*z_m), crossing.facing < 0 || two_sided, crossing.facing > 0 || two_sided});
    }
    std::stable_sort(hits.begin(), hits.end(), [](const ColumnHit& a, const ColumnHit& b) { return a.z_m > b.z_m; });
}

float Scene::distance_to_surface(const glm::vec3& point, float most_m) const {
    struct Search {
        const Scene& scene;
        glm::dvec3 point;
    };
    Search search{*this, point};
    RTCPointQuery query{point.x, point.y, point.z, 0, most_m};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto look = [](RTCPointQueryFunctionArguments* found) {
        const auto& [scene, at] = *static_cast<const Search*>(found->userPtr);
        const bool instanced = found->context->instStackSize > 0;
        const TriangleSet& set = instanced ? scene.set_of(found->context->instID[0], found->geomID) : *scene.large_sets_[found->geomID - scene.map_->objects.size()];
        const map::Object& object = scene.map_->objects[scene.object_index(instanced ? found->context->instID[0] : set.instance)];
        const auto [a, b, c] = world_corners(object, *set.primitive, set.triangle_of(found->primID));
        const auto distance_m = static_cast<float>(distance_to_triangle(at, a, b, c));
        if (!(distance_m < found->query->radius)) return false;
        found->query->radius = distance_m;
        return true;
    };
    rtcPointQuery(handle_, &query, &context, look, &search);
    return query.radius;
}

std::vector<map::Bounds> Scene::vegetation_bounds(const Region& region) const {
    std::vector<map::Bounds> found;
    for (const Instance& instance : instances_) {
        const map::Object& object = map_->objects[instance.object];
        if (object.role == map::Role::vegetation && overlaps(object.bounds, region, 0)) found.push_back(object.bounds);
    }
    return found;
}

}  // namespace drtv::trace
