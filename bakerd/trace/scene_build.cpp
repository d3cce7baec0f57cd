// How a scene is made of a map's objects; what it is asked is in scene.cpp.
#include "bakerd/trace/scene.h"

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace drtv::trace {
namespace {

bool overlaps(const map::Bounds& bounds, const WorldRectangle& region, float margin_m) {
    return bounds.low.x <= region.high.x + margin_m && bounds.high.x >= region.low.x - margin_m &&
           bounds.low.y <= region.high.y + margin_m && bounds.high.y >= region.low.y - margin_m;
}

bool is_mirroring(const glm::mat4x3& world_from_object) {
    const glm::dvec3 x(world_from_object[0]);
    const glm::dvec3 y(world_from_object[1]);
    const glm::dvec3 z(world_from_object[2]);
    return glm::dot(glm::cross(x, y), z) < 0;
}

}  // namespace

// Terrain and the like is cut to what lies within reach: its memory follows the reach too, and rays near it
// need no transform. It must depend on the object alone: a hit's last digits are not the same either way.
bool is_kept_in_world_space(const map::Bounds& bounds) {
    constexpr float side_m = 96;
    return std::max(bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y) > side_m;
}

std::shared_ptr<const Scene> Scene::build(MapGeometry& geometry,
                                          const WorldRectangle& region,
                                          float reach_m) {
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
        if (!overlaps(object.bounds, region, reach_m))
            continue;
        scene->bounds_.extend(object.bounds.low);
        scene->bounds_.extend(object.bounds.high);
        if (is_kept_in_world_space(object.bounds) || !geometry.shape_of(object)) {
            scene->add_in_world_space(n, geometry.closed_parts_of(object.mesh), region, reach_m);
            continue;
        }
        std::shared_ptr<const MeshBvh>& bvh = by_mesh[object.mesh];
        if (!bvh) {
            bvh = geometry.bvh_of(object.mesh);
            scene->kinds_ |= bvh->kinds();
        }
        scene->add_instance(n, *bvh);
    }
    rtcCommitScene(scene->handle_);
    scene->kinds_ |= kinds_of(scene->world_sets_);
    for (auto& bvh : by_mesh) {
        if (bvh)
            scene->meshes_.push_back(std::move(bvh));
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
    instances_.push_back({world_from_object,
                          &bvh,
                          bvh.closed(),
                          object,
                          map_->objects[object].role,
                          is_mirroring(world_from_object)});
}

void Scene::add_in_world_space(std::uint32_t object,
                               std::shared_ptr<const ClosedParts> closed,
                               const WorldRectangle& region,
                               float reach_m) {
    const map::Object& placed = map_->objects[object];
    const glm::dmat4x3 world_from_object(placed.world_from_object);
    const bool mirrored = is_mirroring(placed.world_from_object);
    const auto within_reach = [&](const map::Primitive& primitive, const glm::uvec3& triangle) {
        map::Bounds bounds;
        for (glm::length_t k = 0; k < 3; ++k)
            bounds.extend(glm::vec3(world_from_object * glm::dvec4(primitive.positions[triangle[k]], 1)));
        return overlaps(bounds, region, reach_m);
    };
    for (auto& set : triangle_sets(*map_, map_->meshes[placed.mesh], *closed, within_reach)) {
        set->instance = static_cast<std::uint32_t>(instances_.size());
        set->mirrored = mirrored;
        attach(device_->handle(),
               handle_,
               *set,
               static_cast<std::uint32_t>(map_->objects.size() + world_sets_.size()),
               placed.world_from_object);
        world_sets_.push_back(std::move(set));
    }
    closed_.push_back(std::move(closed));
    instances_.push_back(
        {placed.world_from_object, nullptr, closed_.back().get(), object, placed.role, mirrored});
}

Scene::~Scene() {
    if (handle_ != nullptr)
        rtcReleaseScene(handle_);
}

std::vector<map::Bounds> Scene::vegetation_bounds(const WorldRectangle& region) const {
    std::vector<map::Bounds> found;
    for (const Instance& instance : instances_) {
        const map::Object& object = map_->objects[instance.object];
        if (object.role == map::Role::vegetation && overlaps(object.bounds, region, 0))
            found.push_back(object.bounds);
    }
    return found;
}

}  // namespace drtv::trace
