// The objects within reach of a square of the world, as something rays can be shot at. A query's answer
// depends only on the triangles the ray can meet: not on what else is in the scene, the BVH, or the thread.
#pragma once

#include "bakerd/map/map.h"
#include "bakerd/trace/geometry.h"
#include "bakerd/trace/ray.h"
#include "bakerd/trace/surface.h"
#include "bakerd/trace/triangle.h"
#include "placement/crossings.h"

#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

struct RTCSceneTy;

namespace drtv::trace {

// query.h
struct HitCandidate;
enum class Collected : std::uint8_t;
struct Crossing;
struct Query;

// A ray a hair's breadth beside this one. Embree's robust test gives an edge one sign for both its triangles,
// but rounds the edges around a vertex each by itself: of rays aimed exactly at a vertex, some 10 in a
// million pass between its triangles. Where light must not leak, a miss counts when this one misses too.
[[nodiscard]] Ray beside(const Ray& ray);

struct Hit {
    float distance_m = 0;
    std::uint32_t instance = 0;        // in the scene
    std::uint32_t primitive = 0;       // of the object's mesh
    std::uint32_t triangle = 0;        // of the primitive
    float u = 0, v = 0;                // barycentric: weights of the second and third vertex
    bool front = false;                // the ray met the counter-clockwise side
    glm::vec3 normal{};                // unit, world, on the ray's side
    float double_area_m2 = 0;          // twice the triangle's area in the world
    const TriangleSet* set = nullptr;  // of the triangle
};

// Of the world, metres; x east, y north.
struct WorldRectangle {
    glm::vec2 low{};
    glm::vec2 high{};
};

// Whether a scene has triangles of its own of an object with these bounds, instead of an instance of its
// mesh.
[[nodiscard]] bool is_kept_in_world_space(const map::Bounds& bounds);

class Scene {
  public:
    // All objects whose bounds come within `reach_m` of the region.
    [[nodiscard]] static std::shared_ptr<const Scene> build(MapGeometry& geometry,
                                                            const WorldRectangle& region,
                                                            float reach_m);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    // The closest hit. What alpha takes away lets the ray through; ties go to the object of the smaller
    // digest. Of surfaces in one plane the one that turns its front to the ray is met.
    [[nodiscard]] std::optional<Hit> closest(const Ray& ray) const;
    // Textures are averaged over a width of `footprint_m`.
    [[nodiscard]] Surface surface(const Hit& hit, float footprint_m) const;
    [[nodiscard]] bool occluded(const Ray& ray) const;
    // The same of a ray that ends on a surface, or on a light in its plane: that does not hide it, but for
    // the back of a one-sided one, where no front lies in its plane.
    [[nodiscard]] bool hides_surface(const Ray& ray) const;
    // The same for many rays at once, which Embree does faster where they are incoherent.
    void occluded(std::span<const Ray> rays, std::vector<bool>& answers) const;
    // What clear glass does to light that it lets through. What the ray ends on, as hides_surface has it,
    // does nothing.
    [[nodiscard]] GlassPassed passed(const Ray& ray, bool to_surface = false) const;
    // The share of light that comes along a ray, by channel, as hides_surface (or occluded) has it, but
    // without chance: for rays that stand alone and not for many.
    [[nodiscard]] glm::vec3 share_seen(const Ray& ray, bool to_surface) const;
    // How many surfaces the ray crosses; a front and a back in one plane are one.
    [[nodiscard]] std::size_t crossings(const Ray& ray) const;

    // All crossings of the vertical line at (x, y) with static objects, from the top down; those at one
    // height in an order of their own, not the map's. `hits` is replaced.
    void column(glm::vec2 at, std::vector<placement::ColumnHit>& hits) const;
    // The same, and with all that bounds volumes. The line leans: it passes 3 cm beside the point at most.
    void column_of_spaces(glm::vec2 at, std::vector<placement::ColumnHit>& hits) const;

    // The object that the point is inside of: some closed part whose fronts look outwards has a winding
    // number above 0 there. A closed part that looks inwards, as a room's walls do, takes away from those
    // around it alone. Of several the one of the smallest bounds.
    [[nodiscard]] std::optional<std::uint32_t> closed_around(const glm::vec3& point) const;

    // All crossings with static objects and with what bounds a volume, in no particular order.
    [[nodiscard]] std::vector<placement::Side> sides_met(const Ray& ray) const;

    // Whether something static that is there everywhere stands in the way: it separates what lies before and
    // behind it. Leaves, glass and fences never do.
    [[nodiscard]] bool separated(const Ray& ray) const;

    // The object of which some triangle comes within so much of the point, static or bounding a volume; what
    // alpha takes away counts as there. Of several the nearest, then the first of the map.
    [[nodiscard]] std::optional<std::uint32_t> wall_within(const glm::vec3& point, float max_m) const;

    // To the nearest surface of any kind, at most `max_m`; what alpha takes away counts as there.
    [[nodiscard]] float distance_to_surface(const glm::vec3& point, float max_m) const;

    // World bounds of vegetation that overlap the region (its bounds), in the map's order.
    [[nodiscard]] std::vector<map::Bounds> vegetation_bounds(const WorldRectangle& region) const;

    [[nodiscard]] const map::Bounds& bounds() const { return bounds_; }
    [[nodiscard]] std::size_t object_count() const { return instances_.size(); }
    [[nodiscard]] std::uint32_t object_index(std::uint32_t instance) const {
        return instances_[instance].object;
    }
    [[nodiscard]] const map::Object& object_of(const Hit& hit) const {
        return map_->objects[object_index(hit.instance)];
    }
    [[nodiscard]] const map::Map& map() const { return *map_; }

    [[nodiscard]] map::Role role_of(std::uint32_t instance) const { return instances_[instance].role; }
    [[nodiscard]] const glm::mat4x3& world_from_object(std::uint32_t instance) const {
        return instances_[instance].world_from_object;
    }

    // Whether a ray meets the side that is counter-clockwise in object space.
    [[nodiscard]] bool meets_front(std::uint32_t instance, const Intersection& at, const Ray& ray) const;

    // Embree's scene, for benchmarks that measure what it alone costs.
    [[nodiscard]] RTCSceneTy* embree_scene() const { return handle_; }

  private:
    // One cache line.
    struct alignas(64) Instance {
        glm::mat4x3 world_from_object;
        const MeshBvh* mesh;  // none of one that is kept in world space
        const ClosedParts* closed;
        std::uint32_t object;
        map::Role role;
        bool mirrored;
    };
    Scene() = default;
    void add_instance(std::uint32_t object, const MeshBvh& bvh);
    void add_in_world_space(std::uint32_t object,
                            std::shared_ptr<const ClosedParts> closed,
                            const WorldRectangle& region,
                            float reach_m);
    [[nodiscard]] bool is_met(Query& query, const Ray& ray) const;
    [[nodiscard]] bool ends_behind(const Ray& ray) const;
    void column(glm::vec2 at,
                const glm::vec3& down,
                Collected wanted,
                std::vector<placement::ColumnHit>& hits) const;
    struct Nearest;
    [[nodiscard]] Nearest nearest_surface(const glm::vec3& point, float max_m, bool only_walls) const;
    struct Around;
    [[nodiscard]] map::Bounds bounds_of(std::uint32_t instance, std::uint32_t part) const;
    [[nodiscard]] const ClosedParts* closed_of(std::uint32_t instance) const {
        return instances_[instance].closed;
    }
    void add_around(const Crossing& crossing, bool front, std::vector<Around>& parts) const;
    [[nodiscard]] std::optional<std::uint32_t> closed_around(const Ray& line) const;
    [[nodiscard]] std::vector<Crossing> panes(const Ray& ray, Collected wanted, bool to_surface) const;
    [[nodiscard]] bool is_covered(const Crossing& back,
                                  const std::vector<Crossing>& crossings,
                                  const Ray& ray) const;
    [[nodiscard]] std::optional<Hit> front_skin(const HitCandidate& back,
                                                const Intersection& at,
                                                const Ray& ray) const;
    [[nodiscard]] Hit hit_at(const HitCandidate& candidate, const Intersection& at, const Ray& ray) const;
    [[nodiscard]] std::vector<Crossing> all_crossings(const Ray& ray, Collected wanted) const;
    [[nodiscard]] const TriangleSet& set_of(std::uint32_t instance, std::uint32_t embree_geometry) const;

    std::shared_ptr<const Device> device_;
    std::shared_ptr<const map::Map> map_;
    std::vector<std::shared_ptr<const MeshBvh>> meshes_;  // keeps the instanced BVHs alive
    std::vector<Instance> instances_;                     // in the order of the map's objects
    // Of large objects, and of those that cannot be instances, what lies within reach, in world space. Their
    // geometry ids follow those of all instances.
    std::vector<std::unique_ptr<TriangleSet>> world_sets_;
    std::vector<std::shared_ptr<const ClosedParts>> closed_;  // of their meshes
    mutable std::mutex part_bounds_mutex_;
    // World, by instance and part, as they were asked for; guarded by part_bounds_mutex_.
    mutable std::map<std::pair<std::uint32_t, std::uint32_t>, map::Bounds> part_bounds_;
    map::Bounds bounds_;
    Kinds kinds_;
    RTCSceneTy* handle_ = nullptr;
};

}  // namespace drtv::trace
