// A map as a flat list of world-space triangles in double precision, with a ray query of its own. It shares
// the map loader with the product and nothing else: no Embree, no instances, no pictures of lesser
// resolution.
#pragma once

#include "bakerd/map/map.h"
#include "tests/reference/reference_bvh.h"
#include "tests/reference/reference_random.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace drtv::reference {

// What converts the lights' photometric units (candela, lux, nits) to W/sr, W/m2 and W/(sr m2).
inline constexpr double lumens_per_watt = 683;

struct SurfaceHit {
    double distance_m = 0;
    glm::dvec3 normal{};       // unit, on the ray's side
    glm::dvec3 reflected{};    // share of the light from the ray's side that goes back to it; linear Rec. 709
    glm::dvec3 transmitted{};  // share that goes through; both together at most 0.95
    glm::dvec3 emitted{};      // radiance towards the ray's side, W/(sr m2)
    glm::dvec3 clear{};        // share that goes straight through
    bool absorbs = false;      // the back of a one-sided surface: all three are 0
};

// Triangles that lie outside of this need not be kept.
struct Region {
    glm::dvec3 low{-std::numeric_limits<double>::infinity()}, high{std::numeric_limits<double>::infinity()};
};

class Scene {
  public:
    // REQUIRES: `map` outlives the scene.
    explicit Scene(const map::Map& map, const Region& region = {});

    // The closest hit along the unit `direction`, or nothing. Masked texels let the ray through, blended ones
    // do so with the probability that their alpha lacks of 1, drawn anew at each crossing; clear glass with
    // the luminance of what goes straight through, whose colour `tint` is multiplied with. Of two surfaces in
    // one plane the one that turns its front to the ray is hit.
    [[nodiscard]] std::optional<SurfaceHit> closest(const glm::dvec3& origin, const glm::dvec3& direction,
                                                    Random& random, glm::dvec3& tint) const;

    // The share of light that comes from the point `far_m` along the ray; a surface in whose plane that point
    // lies takes none of it.
    [[nodiscard]] glm::dvec3 arriving(const glm::dvec3& origin, const glm::dvec3& direction, double far_m,
                                      Random& random) const;

    [[nodiscard]] const std::vector<map::Light>& lights() const { return map_.lights; }
    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }

  private:
    struct Triangle {
        glm::dvec3 corner, edge1, edge2;
        std::uint32_t worn = 0;    // index into worn_
        std::uint32_t number = 0;  // of the primitive's triangles
    };
    // A primitive of an object.
    struct Worn {
        const map::Primitive* primitive = nullptr;
        const map::Material* material = nullptr;
        bool vegetation = false, mirrored = false, always_there = true;
    };
    struct Crossing {
        double distance_m, u, v;  // weights of the second and third corner
    };

    void add_object(const map::Object& object, const Region& region);
    [[nodiscard]] static std::optional<Crossing> cross(const Triangle& triangle, const glm::dvec3& origin,
                                                       const glm::dvec3& direction, double far_m);
    // Base colour (w is alpha) before clamping.
    [[nodiscard]] glm::dvec4 colour(const Triangle& triangle, const Crossing& at) const;
    [[nodiscard]] glm::dvec4 picture(const map::TextureView& view, const std::vector<glm::vec2>& uvs,
                                     const Triangle& triangle, const Crossing& at) const;
    [[nodiscard]] bool is_there(const Triangle& triangle, const Crossing& at, Random& random) const;
    struct Met {
        const Triangle* triangle = nullptr;
        Crossing at{};
    };
    // The nearest below `far_m` that is there, glass or not.
    [[nodiscard]] Met nearest(const glm::dvec3& origin, const glm::dvec3& direction, double far_m,
                              Random& random) const;
    // The front in the plane of a back, or the back.
    [[nodiscard]] Met front_of(const Met& met, const glm::dvec3& origin, const glm::dvec3& direction,
                               Random& random) const;
    [[nodiscard]] glm::dvec3 front_normal(const Triangle& triangle) const;
    [[nodiscard]] double transmission(const Triangle& triangle, const Crossing& at) const;
    [[nodiscard]] glm::dvec3 clear_share(const Triangle& triangle, const Crossing& at) const;
    [[nodiscard]] SurfaceHit surface(const Triangle& triangle, const Crossing& at,
                                     const glm::dvec3& direction) const;

    const map::Map& map_;
    std::vector<Worn> worn_;
    std::vector<Triangle> triangles_;
    std::optional<Bvh> bvh_;
};

}  // namespace drtv::reference
