// Who is told of the rays of a bake while they are traced. A change of the map changes a result only where
// such a ray went.
#pragma once

#include "bakerd/trace/ray.h"

#include <drtv/conventions.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace drtv::bake {

// What a change on a ray can alter at most, as a share of the range of coefficients: for each basis
// direction, since their coefficients are told apart.
using Shares = std::array<float, basis_count>;

// Coefficients of static light have no range of their own. Changes of theirs count against this: E/pi in
// W/m2, what some 500 lux make of a white surface.
inline constexpr float static_irradiance_range = 0.25f;

// A straight part of a path.
struct PathSegment {
    trace::Ray ray;
    float length_m;      // beyond it nothing matters
    Shares shares;       // of all that the path brings from here on
    std::uint32_t path;  // number of the path, among those of its probe
    bool implied;        // follows from the probe's place and the settings: nobody needs to note it
};

struct ShadowRay {
    trace::Ray ray;
    Shares shares;
};

// Belongs to one thread. Each call may hold one ray or a whole stream of them.
class RayWatch {
  public:
    virtual ~RayWatch() = default;

    // What follows is traced for the probe at that place, in units of 2^-10 m.
    virtual void begin_probe(const glm::ivec3& position_units) = 0;

    // Segments of one path come in its order. One may come twice, the second time longer: where the surface
    // at its end lets light through.
    virtual void record_segments(std::span<const PathSegment> segments) = 0;

    virtual void record_shadow_rays(std::span<const ShadowRay> rays) = 0;
};

// Gives the watch of the calling thread.
using WatchOfThread = std::function<RayWatch&()>;

}  // namespace drtv::bake
