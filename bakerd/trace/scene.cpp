#include "bakerd/trace/scene.h"

#include "bakerd/trace/query.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::trace {
namespace {

bool overlaps(const map::Bounds& bounds, const Region& region, float margin_m) {
    return bounds.low.x <= region.high.x + margin_m && bounds.high.x >= region.low.x - margin_m && bounds.low.y <= region.high.y + margin_m &&
           bounds.high.y >= region.low.y - margin_m;
}

// In double: a cofactor matrix, which needs no division and keeps the side even where the map mirrors.
glm::mat3 normal_transform(const glm::mat4x3& world_from_object) {
    const glm::dvec3 x(world_from_object[0]), y(world_from_object[1]), z(world_from_object[2]);
    const double sign = glm::dot(glm::cross(x, y), z) < 0 ? -1 : 1;
    return glm::mat3(glm::dmat3(glm::cross(y, z) * sign, glm::cross(z, x) * sign, glm::cross(x, y) * sign));
}

// Height of the triangle's plane at a point inside its plan, from its vertices alone: the distance along a line
// of kilometres would have lost the digits. Nothing for a vertical triangle.
std::optional<double> height_on_triangle(const map::Object& object, const map::Primitive& primitive, std::uint32_t triangle, glm::vec2 at) {
    const glm::uvec3& t = primitive.triangles[triangle];
    const glm::dmat4x3 world_from_object(object.world_from_object);
    const auto corner = [&](std::uint32_t vertex) { return world_from_object * glm::dvec4(primitive.positions[vertex], 1); };
    const glm::dvec3 a = corner(t.x), b = corner(t.y), c = corner(t.z);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (std::abs(normal.z) <= 1e-6 * glm::length(normal)) return std::nullopt;
    const double z_m = a.z - (normal.x * (double{at.x} - a.x) + normal.y * (double{at.y} - a.y)) / normal.z;
    return std::clamp(z_m, std::min({a.z, b.z, c.z}), std::max({a.z, b.z, c.z}));
}

RTCRay embree_ray(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.tfar = ray.far_m;
    r.mask = ~0u;
    return r;
}

RTCRayHit embree_ray_hit(const Ray& ray) {
    RTCRayHit r{};
    r.ray = embree_ray(ray);
    r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return r;
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
        std::shared_ptr<const MeshBvh>& bvh = by_mesh[object.mesh];
        if (!bvh) bvh = geometry.bvh_of(object.mesh);
        RTCGeometry instance = rtcNewGeometry(scene->device_->handle(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, bvh->handle());
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &object.world_from_object[0][0]);
        rtcCommitGeometry(instance);
        rtcAttachGeometryByID(scene->handle_, instance, static_cast<unsigned>(scene->instances_.size()));
        rtcReleaseGeometry(instance);
        scene->instances_.push_back({n, normal_transform(object.world_from_object)});
        scene->bounds_.extend(object.bounds.low);
        scene->bounds_.extend(object.bounds.high);
    }
    rtcCommitScene(scene->handle_);
    for (auto& bvh : by_mesh) {
        if (bvh) scene->meshes_.push_back(std::move(bvh));
    }
    return scene;
}

Scene::~Scene() {
    if (handle_ != nullptr) rtcReleaseScene(handle_);
}

std::optional<Hit> Scene::closest(const Ray& ray) const {
    Query query;
    RTCRayHit r = embree_ray_hit(ray);
    rtcIntersect1(handle_, &query.base, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const glm::vec3 object_normal(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z);
    glm::vec3 normal = instances_[r.hit.instID[0]].world_from_normal * object_normal;
    // The front is counter-clockwise in object space; a cofactor transform keeps the sign of direction . normal.
    const bool front = glm::dot(normal, ray.direction) < 0;
    const float length = glm::length(normal);
    normal = length > 0 ? normal * ((front ? 1.0f : -1.0f) / length) : -ray.direction;
    return Hit{query.best_distance, r.hit.instID[0], r.hit.geomID, r.hit.primID, r.hit.u, r.hit.v, front, normal};
}

Surface Scene::surface(const Hit& hit) const {
    const map::Object& object = object_of(hit);
    const map::Primitive& primitive = map_->meshes[object.mesh].primitives[hit.primitive];
    // Leaves reflect on both sides, whatever the exporter says.
    const bool two_sided = object.role == map::Role::vegetation || map_->materials[primitive.material].double_sided;
    if (!hit.front && !two_sided) return {true, glm::vec3(0)};
    return {false, albedo_at(*map_, primitive, hit.triangle, hit.u, hit.v)};
}

bool Scene::occluded(const Ray& ray) const {
    Query query;
    RTCRay r = embree_ray(ray);
    rtcOccluded1(handle_, &query.base, &r);
    return r.tfar < 0;
}

void Scene::column(glm::vec2 at, std::vector<ColumnHit>& hits) const {
    hits.clear();
    std::vector<Crossing> crossings;
    Query query;
    query.crossings = &crossings;
    // The line's ends are constants: were they taken from the scene, its rounding would depend on far objects.
    RTCRayHit r = embree_ray_hit({glm::vec3(at, map::max_height_m), glm::vec3(0, 0, -1), 2 * map::max_height_m});
    rtcIntersect1(handle_, &query.base, &r);
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.id < b.id; });
    for (std::size_t n = 0; n < crossings.size(); ++n) {
        const Crossing& crossing = crossings[n];
        if (n > 0 && crossing.id == crossings[n - 1].id) continue;
        const map::Object& object = map_->objects[instances_[crossing.id.instance].object];
        if (object.role == map::Role::vegetation) continue;
        const map::Primitive& primitive = map_->meshes[object.mesh].primitives[crossing.id.primitive];
        const std::optional<double> z_m = height_on_triangle(object, primitive, crossing.id.triangle, at);
        if (!z_m) continue;
        const bool two_sided = map_->materials[primitive.material].double_sided;
        hits.push_back({static_cast<float>(*z_m), crossing.facing < 0 || two_sided, crossing.facing > 0 || two_sided});
    }
    std::stable_sort(hits.begin(), hits.end(), [](const ColumnHit& a, const ColumnHit& b) { return a.z_m > b.z_m; });
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
