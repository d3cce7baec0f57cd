// One BVH a mesh, built when a scene first needs it and dropped when no scene does: memory follows the reach,
// not the map. Revisions of a map share those of meshes that did not change.
#pragma once

#include "bakerd/map/map.h"
#include "bakerd/trace/closed_parts.h"
#include "bakerd/trace/device.h"
#include "bakerd/trace/instance_margin.h"
#include "bakerd/trace/triangle_set.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

struct RTCSceneTy;

namespace drtv::trace {

class MeshBvh {
  public:
    // For instances of up to this shape: the box is larger than the mesh by its margin.
    MeshBvh(std::shared_ptr<const Device> device,
            std::shared_ptr<const map::Map> map,
            std::uint32_t mesh,
            std::shared_ptr<const ClosedParts> closed,
            const InstanceShape& shape,
            std::uint64_t revision);
    ~MeshBvh();
    MeshBvh(const MeshBvh&) = delete;
    MeshBvh& operator=(const MeshBvh&) = delete;

    [[nodiscard]] RTCSceneTy* handle() const { return handle_; }
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    [[nodiscard]] const InstanceShape& shape() const { return shape_; }
    [[nodiscard]] Kinds kinds() const { return kinds_of(sets_); }
    [[nodiscard]] const ClosedParts* closed() const { return closed_.get(); }
    // Not one of a triangle set: there to widen the box.
    [[nodiscard]] bool is_margin(std::uint32_t embree_geometry) const {
        return embree_geometry == sets_.size();
    }
    [[nodiscard]] const TriangleSet& set(std::uint32_t embree_geometry) const {
        return *sets_[embree_geometry];
    }

  private:
    std::shared_ptr<const Device> device_;
    std::shared_ptr<const map::Map> map_;
    std::shared_ptr<const ClosedParts> closed_;
    std::vector<std::unique_ptr<TriangleSet>> sets_;  // by Embree's geometry id
    const InstanceShape shape_;
    const std::uint64_t revision_;
    RTCSceneTy* handle_;
};

// BVHs by the digest of their meshes, for the maps that are opened one after the other. Thread-safe.
class MeshShelf {
  public:
    // The number of the next map.
    [[nodiscard]] std::uint64_t next_revision();
    // One that a scene still holds and that is good for the shape; nothing otherwise. A BVH keeps its whole
    // map in memory: that of a map opened long ago is not handed out any more.
    [[nodiscard]] std::shared_ptr<const MeshBvh> find(const map::Digest& mesh,
                                                      const InstanceShape& shape,
                                                      std::uint64_t revision);
    void keep(const map::Digest& mesh, const std::shared_ptr<const MeshBvh>& bvh);

    // The same of closed parts, which know nothing of their map.
    [[nodiscard]] std::shared_ptr<const ClosedParts> find_closed(const map::Digest& mesh);
    void keep_closed(const map::Digest& mesh, const std::shared_ptr<const ClosedParts>& closed);

  private:
    std::mutex mutex_;
    std::uint64_t revisions_ = 0;                                     // guarded by mutex_
    std::map<map::Digest, std::weak_ptr<const MeshBvh>> by_mesh_;     // guarded by mutex_
    std::map<map::Digest, std::weak_ptr<const ClosedParts>> closed_;  // guarded by mutex_
};

// The meshes of one map. Thread-safe.
class MapGeometry {
  public:
    // With a shelf, meshes that an earlier map had are taken from there.
    MapGeometry(std::shared_ptr<const Device> device,
                std::shared_ptr<const map::Map> map,
                std::shared_ptr<MeshShelf> shelf = nullptr);

    [[nodiscard]] std::shared_ptr<const MeshBvh> bvh_of(std::uint32_t mesh);
    [[nodiscard]] std::shared_ptr<const ClosedParts> closed_parts_of(std::uint32_t mesh);
    // Nothing for an object that cannot be an instance.
    [[nodiscard]] std::optional<InstanceShape> shape_of(const map::Object& object) const {
        return instance_shape(object.world_from_object, margin_m_);
    }
    [[nodiscard]] const std::shared_ptr<const map::Map>& map() const { return map_; }
    [[nodiscard]] const std::shared_ptr<const Device>& device() const { return device_; }

  private:
    struct Slot {
        InstanceShape shape;  // the largest of all its instances; constant after construction
        std::mutex mutex;     // guards the rest
        std::weak_ptr<const MeshBvh> bvh;
        std::shared_ptr<const ClosedParts> closed;  // once asked for
    };
    const std::shared_ptr<const Device> device_;
    const std::shared_ptr<const map::Map> map_;
    const std::shared_ptr<MeshShelf> shelf_;  // may be none
    [[nodiscard]] const std::shared_ptr<const ClosedParts>& closed_parts_of(std::uint32_t mesh, Slot& slot);

    const std::uint64_t revision_;
    const float margin_m_;
    std::vector<Slot> slots_;  // by mesh
};

}  // namespace drtv::trace
