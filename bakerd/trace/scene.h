// The objects within reach of a square of the world, as something rays can be shot at. A query's answer depends
// only on the triangles the ray can meet: not on what else is in the scene, the BVH, or the thread.
#pragma once

#include "bakerd/map/map.h"
#include "bakerd/trace/geometry.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

struct RTCSceneTy;

namespace drtv::trace {

struct Ray {
    glm::vec3 origin;
    glm::vec3 direction;  // unit
    float far_m = 0;      // hits at this distance or less count
};

struct Hit {
    float distance_m = 0;
    std::uint32_t instance = 0;   // in the scene
    std::uint32_t primitive = 0;  // of the object's mesh
    std::uint32_t triangle = 0;   // of the primitive
    float u = 0, v = 0;           // barycentric: weights of the second and third vertex
    bool front = false;           // the ray met the counter-clockwise side
    glm::vec3 normal{};           // unit, world, on the ray's side
};

// What a hit sends back.
struct Surface {
    bool absorbs = false;   // the back of a one-sided surface: neither sky nor bounce
    glm::vec3 albedo{};     // linear Rec. 709
};

// One crossing of a vertical line with a static object.
struct ColumnHit {
    float z_m = 0;
    bool up_facing = false;    // seen from above it is a front, or it has two fronts
    bool down_facing = false;  // seen from below it is a front, or it has two fronts
};

// Square of the world, metres.
struct Region {
    glm::vec2 low, high;
};

class Scene {
  public:
    // All objects whose bounds come within `reach_m` of the region.
    [[nodiscard]] static std::shared_ptr<const Scene> build(MapGeometry& geometry, const Region& region, float reach_m);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    // The closest hit. Masked texels let the ray through; ties go to the object of the smaller digest.
    [[nodiscard]] std::optional<Hit> closest(const Ray& ray) const;
    [[nodiscard]] Surface surface(const Hit& hit) const;
    [[nodiscard]] bool occluded(const Ray& ray) const;

    // All crossings of the vertical line at (x, y) with static objects, from the top down; `hits` is replaced.
    void column(glm::vec2 at, std::vector<ColumnHit>& hits) const;

    // World bounds of vegetation that overlap the region (its bounds), in the map's order.
    [[nodiscard]] std::vector<map::Bounds> vegetation_bounds(const Region& region) const;

    [[nodiscard]] const map::Bounds& bounds() const { return bounds_; }
    [[nodiscard]] std::size_t object_count() const { return instances_.size(); }
    [[nodiscard]] const map::Object& object_of(const Hit& hit) const { return map_->objects[instances_[hit.instance].object]; }

    // Embree's scene, for benchmarks that measure what it alone costs.
    [[nodiscard]] RTCSceneTy* embree_scene() const { return handle_; }

  private:
    struct Instance {
        std::uint32_t object;
        glm::mat3 world_from_normal;  // inverse transpose, not normalised
    };
    Scene() = default;

    std::shared_ptr<const Device> device_;
    std::shared_ptr<const map::Map> map_;
    std::vector<std::shared_ptr<const MeshBvh>> meshes_;  // keeps the instanced BVHs alive
    std::vector<Instance> instances_;                     // in the order of the map's objects
    map::Bounds bounds_;
    RTCSceneTy* handle_ = nullptr;
};

}  // namespace drtv::trace
