// Embree by itself on the same map: one BVH a mesh, instances, robust, single rays; no filters, no surfaces.
#pragma once

#include "bakerd/map/map.h"
#include "bakerd/trace/scene.h"

#include <embree3/rtcore.h>

#include <span>
#include <vector>

namespace drtv::bench {

class RawEmbree {
  public:
    explicit RawEmbree(const map::Map& map);
    ~RawEmbree();
    RawEmbree(const RawEmbree&) = delete;
    RawEmbree& operator=(const RawEmbree&) = delete;

    // Closest hits of all rays; gives how many hit.
    // Closest hits of the first, occlusion of the second, a ray at a time.
    [[nodiscard]] std::size_t trace(std::span<const trace::Ray> closest,
                                    std::span<const trace::Ray> shadows) const;

  private:
    RTCDevice device_;
    std::vector<RTCScene> meshes_;
    RTCScene scene_;
};

}  // namespace drtv::bench
