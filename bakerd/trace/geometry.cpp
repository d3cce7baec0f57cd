#include "bakerd/trace/geometry.h"

#include <embree3/rtcore.h>

namespace drtv::trace {

MeshBvh::MeshBvh(std::shared_ptr<const Device> device, std::shared_ptr<const map::Map> map, std::uint32_t mesh)
    : device_(std::move(device)), map_(std::move(map)), sets_(triangle_sets(*map_, map_->meshes[mesh])), handle_(rtcNewScene(device_->handle())) {
    rtcSetSceneFlags(handle_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(handle_, RTC_BUILD_QUALITY_MEDIUM);
    for (std::uint32_t n = 0; n < sets_.size(); ++n) attach(device_->handle(), handle_, *sets_[n], n);
    rtcCommitScene(handle_);
}

MeshBvh::~MeshBvh() { rtcReleaseScene(handle_); }

MapGeometry::MapGeometry(std::shared_ptr<const Device> device, std::shared_ptr<const map::Map> map)
    : device_(std::move(device)), map_(std::move(map)), slots_(map_->meshes.size()) {}

std::shared_ptr<const MeshBvh> MapGeometry::bvh_of(std::uint32_t mesh) {
    Slot& slot = slots_[mesh];
    const std::lock_guard lock(slot.mutex);
    std::shared_ptr<const MeshBvh> bvh = slot.bvh.lock();
    if (!bvh) {
        bvh = std::make_shared<const MeshBvh>(device_, map_, mesh);
        slot.bvh = bvh;
    }
    return bvh;
}

}  // namespace drtv::trace
