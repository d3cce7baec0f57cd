#include "tests/bench/raw_embree.h"

#include "bakerd/trace/query.h"

#include <cstring>

namespace drtv::bench {

RawEmbree::RawEmbree(const map::Map& map) : device_(rtcNewDevice("isa=avx2")), scene_(rtcNewScene(device_)) {
    for (const map::Mesh& mesh : map.meshes) {
        RTCScene scene = rtcNewScene(device_);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        for (const map::Primitive& primitive : mesh.primitives) {
            RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
            std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                sizeof(glm::vec3), primitive.positions.size()),
                        primitive.positions.data(), primitive.positions.size() * sizeof(glm::vec3));
            std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                sizeof(glm::uvec3), primitive.triangles.size()),
                        primitive.triangles.data(), primitive.triangles.size() * sizeof(glm::uvec3));
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene, geometry);
            rtcReleaseGeometry(geometry);
        }
        rtcCommitScene(scene);
        meshes_.push_back(scene);
    }
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    for (const map::Object& object : map.objects) {
        RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, meshes_[object.mesh]);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                &object.world_from_object[0][0]);
        rtcCommitGeometry(instance);
        rtcAttachGeometry(scene_, instance);
        rtcReleaseGeometry(instance);
    }
    rtcCommitScene(scene_);
}

RawEmbree::~RawEmbree() {
    rtcReleaseScene(scene_);
    for (RTCScene mesh : meshes_)
        rtcReleaseScene(mesh);
    rtcReleaseDevice(device_);
}

std::size_t RawEmbree::trace(std::span<const trace::Ray> closest, std::span<const trace::Ray> shadows) const {
    std::size_t hits = 0;
    for (const trace::Ray& ray : closest) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit r;
        trace::set_ray(r, ray.origin, ray.direction, ray.far_m);
        rtcIntersect1(scene_, &context, &r);
        hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1u : 0u;
    }
    for (const trace::Ray& ray : shadows) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay r;
        trace::set_ray(r, ray.origin, ray.direction, ray.far_m);
        rtcOccluded1(scene_, &context, &r);
        hits += r.tfar < 0 ? 1u : 0u;
    }
    return hits;
}

}  // namespace drtv::bench
