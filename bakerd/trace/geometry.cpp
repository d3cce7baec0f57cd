#include "bakerd/trace/geometry.h"

#include <embree3/rtcore.h>

namespace drtv::trace {

MeshBvh::MeshBvh(std::shared_ptr<const Device> device, std::shared_ptr<const map::Map> map, std::uint32_t mesh, std::uint64_t revision)
    : device_(std::move(device)), map_(std::move(map)), sets_(triangle_sets(*map_, map_->meshes[mesh])), revision_(revision), handle_(rtcNewScene(device_->handle())) {
    rtcSetSceneFlags(handle_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(handle_, RTC_BUILD_QUALITY_MEDIUM);
    for (std::uint32_t n = 0; n < sets_.size(); ++n) attach(device_->handle(), handle_, *sets_[n], n);
    rtcCommitScene(handle_);
}

MeshBvh::~MeshBvh() { rtcReleaseScene(handle_); }

std::uint64_t MeshShelf::next_revision() {
    const std::lock_guard lock(mutex_);
    std::erase_if(by_mesh_, [](const auto& entry) { return entry.second.expired(); });
    return revisions_++;
}

std::shared_ptr<const MeshBvh> MeshShelf::find(const map::Digest& mesh, std::uint64_t revision) {
    constexpr std::uint64_t most_revisions = 8;
    const std::lock_guard lock(mutex_);
    const auto found = by_mesh_.find(mesh);
    if (found == by_mesh_.end()) return nullptr;
    std::shared_ptr<const MeshBvh> bvh = found->second.lock();
    return bvh && revision - bvh->revision() < most_revisions ? bvh : nullptr;
}

void MeshShelf::keep(const map::Digest& mesh, const std::shared_ptr<const MeshBvh>& bvh) {
    const std::lock_guard lock(mutex_);
    by_mesh_[mesh] = bvh;
}

MapGeometry::MapGeometry(std::shared_ptr<const Device> device, std::shared_ptr<const map::Map> map, std::shared_ptr<MeshShelf> shelf)
    : device_(std::move(device)), map_(std::move(map)), shelf_(std::move(shelf)), revision_(shelf_ ? shelf_->next_revision() : 0), slots_(map_->meshes.size()) {}

std::shared_ptr<const MeshBvh> MapGeometry::bvh_of(std::uint32_t mesh) {
    Slot& slot = slots_[mesh];
    const std::lock_guard lock(slot.mutex);
    std::shared_ptr<const MeshBvh> bvh = slot.bvh.lock();
    if (!bvh && shelf_) bvh = shelf_->find(map_->meshes[mesh].digest, revision_);
    if (!bvh) {
        bvh = std::make_shared<const MeshBvh>(device_, map_, mesh, revision_);
        if (shelf_) shelf_->keep(map_->meshes[mesh].digest, bvh);
    }
    slot.bvh = bvh;
    return bvh;
}

}  // namespace drtv::trace
