#include "bakerd/trace/geometry.h"

#include "bakerd/trace/query.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>

#include <cassert>
#include <cstring>

namespace drtv::trace {

struct MeshBvh::Alpha {
    const map::Map* map = nullptr;
    const map::Primitive* primitive = nullptr;
    bool masked = false;
};

struct Filters {
    static bool lets_through(const RTCFilterFunctionNArguments& args) {
        const auto& alpha = *static_cast<const MeshBvh::Alpha*>(args.geometryUserPtr);
        if (!alpha.masked) return false;
        const float u = RTCHitN_u(args.hit, 1, 0), v = RTCHitN_v(args.hit, 1, 0);
        return alpha_at(*alpha.map, *alpha.primitive, RTCHitN_primID(args.hit, 1, 0), u, v) < alpha.map->materials[alpha.primitive->material].alpha_cutoff;
    }

    // Keeps the closest hit, and of several at the same distance the one of the smallest id: the order in which
    // the BVH offers them does not matter. The limit is left a little behind the hit, because Embree compares
    // undivided distances and could otherwise drop an equal one by rounding.
    static void intersect(const RTCFilterFunctionNArguments* args) {
        assert(args->N == 1);
        if (args->valid[0] != -1) return;
        auto& query = *reinterpret_cast<Query*>(args->context);
        if (lets_through(*args)) {
            args->valid[0] = 0;
            return;
        }
        const TriangleId id{RTCHitN_instID(args->hit, 1, 0, 0), RTCHitN_geomID(args->hit, 1, 0), RTCHitN_primID(args->hit, 1, 0)};
        float& limit = RTCRayN_tfar(args->ray, 1, 0);
        const float distance = limit;
        if (query.crossings != nullptr) {
            const float facing = RTCRayN_dir_x(args->ray, 1, 0) * RTCHitN_Ng_x(args->hit, 1, 0) + RTCRayN_dir_y(args->ray, 1, 0) * RTCHitN_Ng_y(args->hit, 1, 0) +
                                 RTCRayN_dir_z(args->ray, 1, 0) * RTCHitN_Ng_z(args->hit, 1, 0);
            query.crossings->push_back({distance, id, facing});
            args->valid[0] = 0;
            return;
        }
        if (distance > query.best_distance || (distance == query.best_distance && query.best < id)) {
            args->valid[0] = 0;
            return;
        }
        query.best_distance = distance;
        query.best = id;
        limit = distance * (1 + 0x1p-20f);
    }

    static void occluded(const RTCFilterFunctionNArguments* args) {
        assert(args->N == 1);
        if (args->valid[0] == -1 && lets_through(*args)) args->valid[0] = 0;
    }
};

MeshBvh::MeshBvh(std::shared_ptr<const Device> device, std::shared_ptr<const map::Map> map, std::uint32_t mesh)
    : device_(std::move(device)), map_(std::move(map)), handle_(rtcNewScene(device_->handle())) {
    rtcSetSceneFlags(handle_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(handle_, RTC_BUILD_QUALITY_MEDIUM);
    for (const map::Primitive& primitive : map_->meshes[mesh].primitives) {
        RTCGeometry geometry = rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_TRIANGLE);
        const std::size_t vertex_bytes = primitive.positions.size() * sizeof(glm::vec3), index_bytes = primitive.triangles.size() * sizeof(glm::uvec3);
        // Embree's own buffers, because it reads some bytes past the last vertex.
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), primitive.positions.size());
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), primitive.triangles.size());
        std::memcpy(vertices, primitive.positions.data(), vertex_bytes);
        std::memcpy(indices, primitive.triangles.data(), index_bytes);
        const map::Material& material = map_->materials[primitive.material];
        alphas_.push_back(std::make_unique<Alpha>(Alpha{map_.get(), &primitive, material.masked}));
        rtcSetGeometryUserData(geometry, alphas_.back().get());
        rtcSetGeometryIntersectFilterFunction(geometry, Filters::intersect);
        if (material.masked) rtcSetGeometryOccludedFilterFunction(geometry, Filters::occluded);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(handle_, geometry);
        rtcReleaseGeometry(geometry);
    }
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
