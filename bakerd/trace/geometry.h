// One BVH a mesh, built when a scene first needs it and dropped when no scene does: memory follows the reach,
// not the map.
#pragma once

#include "bakerd/map/map.h"
#include "bakerd/trace/device.h"
#include "bakerd/trace/triangle_set.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

struct RTCSceneTy;

namespace drtv::trace {

class MeshBvh {
  public:
    MeshBvh(std::shared_ptr<const Device> device, std::shared_ptr<const map::Map> map, std::uint32_t mesh);
    ~MeshBvh();
    MeshBvh(const MeshBvh&) = delete;
    MeshBvh& operator=(const MeshBvh&) = delete;

    [[nodiscard]] RTCSceneTy* handle() const { return handle_; }
    [[nodiscard]] const TriangleSet& set(std::uint32_t embree_geometry) const { return *sets_[embree_geometry]; }

  private:
    std::shared_ptr<const Device> device_;
    std::shared_ptr<const map::Map> map_;
    std::vector<std::unique_ptr<TriangleSet>> sets_;  // by Embree's geometry id
    RTCSceneTy* handle_;
};

// The meshes of one map. Thread-safe.
class MapGeometry {
  public:
    MapGeometry(std::shared_ptr<const Device> device, std::shared_ptr<const map::Map> map);

    [[nodiscard]] std::shared_ptr<const MeshBvh> bvh_of(std::uint32_t mesh);
    [[nodiscard]] const std::shared_ptr<const map::Map>& map() const { return map_; }
    [[nodiscard]] const std::shared_ptr<const Device>& device() const { return device_; }

  private:
    struct Slot {
        std::mutex mutex;  // guards bvh
        std::weak_ptr<const MeshBvh> bvh;
    };
    const std::shared_ptr<const Device> device_;
    const std::shared_ptr<const map::Map> map_;
    std::vector<Slot> slots_;  // by mesh
};

}  // namespace drtv::trace
