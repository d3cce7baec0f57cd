// The intersection from the corners, and the bounds on Embree's own that decide when it is worked out.
#include "bakerd/trace/device.h"
#include "bakerd/trace/triangle.h"
#include "tests/trace/scenes.h"

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace drtv::test {
namespace {

using trace::Ray;

using Points = std::array<glm::vec3, 3>;

trace::ObjectTriangle triangle_of(const Points& p) { return {p[0], p[1], p[2]}; }

TEST(Triangle, IsMetWhereItWasAimedAt) {
    std::mt19937 random(5);
    for (int n = 0; n < 20000; ++n) {
        const Points p = {random_direction(random) * 9.0f, random_direction(random) * 9.0f, random_direction(random) * 9.0f};
        const glm::mat4x3 placed(random_placement(random, 300, n % 2 == 0));
        float u = between(random, 0, 1), v = between(random, 0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::dvec3 target = glm::dmat4x3(placed) * glm::dvec4(glm::dvec3(p[0]) * (1.0 - double{u} - double{v}) + glm::dvec3(p[1]) * double{u} + glm::dvec3(p[2]) * double{v}, 1);
        const glm::vec3 origin = glm::vec3(target) + random_direction(random) * between(random, 1, 200);
        const glm::dvec3 way = target - glm::dvec3(origin);
        const Ray ray{origin, glm::vec3(glm::normalize(way)), 1000};
        const auto met = trace::intersect(ray, placed, triangle_of(p));
        ASSERT_TRUE(met);
        const double cosine = std::abs(glm::dot(met->normal, glm::normalize(way))) / glm::length(met->normal);
        if (cosine < 0.02) continue;
        // The direction is rounded to single precision.
        const double tolerance = 4e-7 * glm::length(way) / cosine, shortest = glm::length(met->normal) / 20;
        EXPECT_NEAR(met->distance_m, glm::length(way), tolerance);
        EXPECT_NEAR(met->u, u, tolerance / shortest + 1e-6);
        EXPECT_NEAR(met->v, v, tolerance / shortest + 1e-6);
    }
}

TEST(Triangle, PointStaysInsideBesideAnEdge) {
    const Points p = {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
    for (const glm::vec2 beside : {glm::vec2(-1e-4f, 0.5f), glm::vec2(0.5f, -1e-4f), glm::vec2(0.6f, 0.6f), glm::vec2(-1, -1)}) {
        const auto met = trace::intersect({glm::vec3(beside, 2), {0, 0, -1}, 9}, glm::mat4x3(1), triangle_of(p));
        ASSERT_TRUE(met);
        EXPECT_GE(met->u, 0);
        EXPECT_GE(met->v, 0);
        EXPECT_LE(met->u + met->v, 1);
        EXPECT_EQ(met->distance_m, 2);
    }
    // Almost in the plane, which is met a kilometre behind the triangle: not farther than its corners.
    const auto grazing = trace::intersect({{-5, 0.25f, 1e-6f}, glm::normalize(glm::vec3(1, 0, -1e-9f)), 2000}, glm::mat4x3(1), triangle_of(p));
    ASSERT_TRUE(grazing);
    EXPECT_LE(grazing->distance_m, 6.001);
    EXPECT_FALSE(trace::intersect({{-5, 0.25f, 0}, {1, 0, 0}, 9}, glm::mat4x3(1), triangle_of(p)));
}

// One triangle as an instance, by Embree alone.
class EmbreeTriangle {
  public:
    EmbreeTriangle(RTCDevice device, const Points& points, const glm::mat4x3& placed) : mesh_(rtcNewScene(device)), scene_(rtcNewScene(device)) {
        rtcSetSceneFlags(mesh_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry triangle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(triangle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(triangle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 1));
        for (std::uint32_t k = 0; k < 3; ++k) {
            vertices[k] = points[k];
            indices[k] = k;
        }
        attach(mesh_, triangle);
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, mesh_);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &placed[0][0]);
        attach(scene_, instance);
    }
    ~EmbreeTriangle() {
        rtcReleaseScene(scene_);
        rtcReleaseScene(mesh_);
    }
    EmbreeTriangle(const EmbreeTriangle&) = delete;
    EmbreeTriangle& operator=(const EmbreeTriangle&) = delete;

    [[nodiscard]] RTCRayHit met_by(const Ray& ray) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit r{};
        r.ray.org_x = ray.origin.x, r.ray.org_y = ray.origin.y, r.ray.org_z = ray.origin.z;
        r.ray.dir_x = ray.direction.x, r.ray.dir_y = ray.direction.y, r.ray.dir_z = ray.direction.z;
        r.ray.tfar = 1e30f;
        r.ray.mask = ~0u;
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &r);
        return r;
    }

  private:
    static void attach(RTCScene scene, RTCGeometry geometry) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
    }
    RTCScene mesh_, scene_;
};

TEST(Triangle, EmbreeErrsByLessThanItsBound) {
    const trace::FloatMode float_mode;
    const auto device = trace::Device::open().value();
    std::mt19937 random(17);
    const auto power = [&](float low, float high) { return std::pow(10.0f, between(random, low, high)); };
    double worst_sure = 0, worst_order = 0;
    int sure = 0, met = 0;
    for (int n = 0; n < 4000; ++n) {
        const float size = power(-2, 2);
        Points p;
        for (glm::vec3& corner : p) corner = glm::vec3(between(random, -size, size), between(random, -size, size), between(random, -size, size) * power(-5, 0));
        const glm::mat4x3 placed(n % 4 == 0 ? glm::dmat4(1) : random_placement(random, power(0, 3.5f), n % 2 == 0));
        const auto shape = trace::instance_shape(placed, 1);
        ASSERT_TRUE(shape);
        const EmbreeTriangle embree(device->handle(), p, placed);
        const float longest = std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])}) * (1 + 0x1p-20f);
        const glm::dmat3 object_from_world = glm::inverse(glm::dmat3(glm::mat3(placed)));
        const trace::Triangle world = trace::transformed(placed, triangle_of(p));
        const glm::dvec3 normal = glm::normalize(glm::cross(world.b - world.a, world.c - world.a));
        for (int k = 0; k < 100; ++k) {
            double u = double{between(random, 0, 1)}, v = double{between(random, 0, 1)};
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const glm::dvec3 target = world.a * (1 - u - v) + world.b * u + world.c * v;
            glm::dvec3 direction(random_direction(random));
            direction -= normal * glm::dot(direction, normal) * (1 - double{power(-6, 0)});
            const glm::vec3 origin(target - glm::normalize(direction) * double{power(-1, 3)});
            const Ray ray{origin, glm::vec3(glm::normalize(target - glm::dvec3(origin))), 1e5f};
            const RTCRayHit r = embree.met_by(ray);
            const auto at = trace::intersect(ray, placed, triangle_of(p));
            if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID || !at) continue;
            ++met;
            const glm::vec3 object_direction(object_from_world * glm::dvec3(ray.direction));
            const double error_m = std::abs(double{r.ray.tfar} - at->distance_m), slack_m = double{trace::query_slack(ray, static_cast<float>(at->distance_m))};
            const trace::EmbreeHit offered{r.ray.tfar, object_direction, {r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z}, longest, shape->spread};
            trace::EmbreeHit exact = offered;
            exact.distance_m = static_cast<float>(at->distance_m);
            exact.normal = glm::vec3(glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0])));
            const double order_m = double{trace::order_of(*at, ray, exact)};
            if (trace::is_sure(ray, offered)) {
                ++sure;
                worst_sure = std::max(worst_sure, error_m / slack_m);
                EXPECT_NEAR(order_m, at->distance_m, at->distance_m * 1e-6) << "what is sure is ordered by its distance";
            }
            // Where the normal is more than rounding, a limit at the order and the slack does not lose the hit.
            const double height = glm::length(glm::dvec3(exact.normal)) / double{longest}, farthest = double{r.ray.tfar * glm::length(object_direction) + longest};
            const double cosine = std::abs(glm::dot(glm::normalize(glm::dvec3(exact.normal)), glm::normalize(glm::dvec3(object_direction))));
            if (cosine > 16 * farthest / height * 0x1p-24) worst_order = std::max(worst_order, (double{r.ray.tfar} - order_m) / slack_m);
        }
    }
    EXPECT_GT(met, 300000);
    EXPECT_GT(sure, 50000);
    EXPECT_LT(worst_sure, 0.5);
    EXPECT_LT(worst_order, 1);
    RecordProperty("worst_sure", std::to_string(worst_sure));
    RecordProperty("worst_order", std::to_string(worst_order));
    std::printf("sure: off by up to %.3f of the slack; grazing: beyond the order by up to %.3f of it; %d of %d sure\n", worst_sure, worst_order, sure, met);
}

}  // namespace
}  // namespace drtv::test
