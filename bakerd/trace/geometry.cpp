#include "bakerd/trace/geometry.h"

#include <embree3/rtcore.h>

namespace drtv::trace {
namespace {

// Widens the scene's box to the two points, and is never met: triangles without extent.
void attach_points(
    RTCDevice device, RTCScene scene, const glm::vec3& low, const glm::vec3& high, unsigned id) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 2));
    auto* indices = static_cast<glm::uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), 2));
    vertices[0] = low;
    vertices[1] = high;
    indices[0] = {0, 0, 0};
    indices[1] = {1, 1, 1};
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

}  // namespace

MeshBvh::MeshBvh(std::shared_ptr<const Device> device,
                 std::shared_ptr<const map::Map> map,
                 std::uint32_t mesh,
                 std::shared_ptr<const ClosedParts> closed,
                 const InstanceShape& shape,
                 std::uint64_t revision)
    : device_(std::move(device)),
      map_(std::move(map)),
      closed_(std::move(closed)),
      sets_(triangle_sets(*map_, map_->meshes[mesh], *closed_)),
      shape_(shape),
      revision_(revision),
      handle_(rtcNewScene(device_->handle())) {
    rtcSetSceneFlags(handle_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(handle_, RTC_BUILD_QUALITY_MEDIUM);
    for (std::uint32_t n = 0; n < sets_.size(); ++n) {
        sets_[n]->spread = shape_.spread;
        attach(device_->handle(), handle_, *sets_[n], n);
    }
    const map::Bounds& bounds = map_->meshes[mesh].bounds;
    attach_points(device_->handle(),
                  handle_,
                  bounds.low - shape_.margin,
                  bounds.high + shape_.margin,
                  static_cast<unsigned>(sets_.size()));
    rtcCommitScene(handle_);
}

MeshBvh::~MeshBvh() {
    rtcReleaseScene(handle_);
}

std::uint64_t MeshShelf::next_revision() {
    const std::lock_guard lock(mutex_);
    std::erase_if(by_mesh_, [](const auto& entry) { return entry.second.expired(); });
    std::erase_if(closed_, [](const auto& entry) { return entry.second.expired(); });
    return revisions_++;
}

std::shared_ptr<const MeshBvh> MeshShelf::find(const map::Digest& mesh,
                                               const InstanceShape& shape,
                                               std::uint64_t revision) {
    constexpr std::uint64_t max_revisions = 8;
    const std::lock_guard lock(mutex_);
    const auto found = by_mesh_.find(mesh);
    if (found == by_mesh_.end())
        return nullptr;
    std::shared_ptr<const MeshBvh> bvh = found->second.lock();
    return bvh && bvh->shape().covers(shape) && revision - bvh->revision() < max_revisions ? bvh : nullptr;
}

void MeshShelf::keep(const map::Digest& mesh, const std::shared_ptr<const MeshBvh>& bvh) {
    const std::lock_guard lock(mutex_);
    by_mesh_[mesh] = bvh;
}

std::shared_ptr<const ClosedParts> MeshShelf::find_closed(const map::Digest& mesh) {
    const std::lock_guard lock(mutex_);
    const auto found = closed_.find(mesh);
    return found == closed_.end() ? nullptr : found->second.lock();
}

void MeshShelf::keep_closed(const map::Digest& mesh, const std::shared_ptr<const ClosedParts>& closed) {
    const std::lock_guard lock(mutex_);
    closed_[mesh] = closed;
}

MapGeometry::MapGeometry(std::shared_ptr<const Device> device,
                         std::shared_ptr<const map::Map> map,
                         std::shared_ptr<MeshShelf> shelf)
    : device_(std::move(device)),
      map_(std::move(map)),
      shelf_(std::move(shelf)),
      revision_(shelf_ ? shelf_->next_revision() : 0),
      margin_m_(instance_margin_m(*map_)),
      slots_(map_->meshes.size()) {
    for (const map::Object& object : map_->objects) {
        const std::optional<InstanceShape> shape = shape_of(object);
        if (shape)
            slots_[object.mesh].shape.extend(*shape);
    }
}

std::shared_ptr<const MeshBvh> MapGeometry::bvh_of(std::uint32_t mesh) {
    Slot& slot = slots_[mesh];
    const std::lock_guard lock(slot.mutex);
    std::shared_ptr<const MeshBvh> bvh = slot.bvh.lock();
    if (!bvh && shelf_)
        bvh = shelf_->find(map_->meshes[mesh].digest, slot.shape, revision_);
    if (!bvh) {
        bvh = std::make_shared<const MeshBvh>(
            device_, map_, mesh, closed_parts_of(mesh, slot), slot.shape, revision_);
        if (shelf_)
            shelf_->keep(map_->meshes[mesh].digest, bvh);
    }
    slot.bvh = bvh;
    return bvh;
}

std::shared_ptr<const ClosedParts> MapGeometry::closed_parts_of(std::uint32_t mesh) {
    Slot& slot = slots_[mesh];
    const std::lock_guard lock(slot.mutex);
    return closed_parts_of(mesh, slot);
}

// REQUIRES: the slot's mutex is held.
const std::shared_ptr<const ClosedParts>& MapGeometry::closed_parts_of(std::uint32_t mesh, Slot& slot) {
    if (slot.closed)
        return slot.closed;
    const map::Digest& digest = map_->meshes[mesh].digest;
    if (shelf_)
        slot.closed = shelf_->find_closed(digest);
    if (!slot.closed) {
        slot.closed = std::make_shared<const ClosedParts>(*map_, map_->meshes[mesh]);
        if (shelf_)
            shelf_->keep_closed(digest, slot.closed);
    }
    return slot.closed;
}

}  // namespace drtv::trace
