// The intersection from the corners, and the bounds on Embree's own that decide when it is worked out.
#include "bakerd/trace/triangle.h"
#include "bakerd/trace/device.h"
#include "bakerd/trace/instance_margin.h"
#include "bakerd/trace/query.h"
#include "tests/trace/scenes.h"

#include <embree3/rtcore.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace drtv::test {
namespace {

using trace::Ray;

using Points = std::array<glm::vec3, 3>;

trace::ObjectTriangle triangle_of(const Points& p) {
    return {p[0], p[1], p[2]};
}

TEST(Triangle, IsMetWhereItWasAimedAt) {
    std::mt19937 random(5);
    for (int n = 0; n < 20000; ++n) {
        const Points p = {random_direction(random) * 9.0f, random_direction(random) * 9.0f,
                          random_direction(random) * 9.0f};
        const glm::mat4x3 placed(random_placement(random, 300, n % 2 == 0));
        float u = between(random, 0, 1), v = between(random, 0, 1);
        if (u + v > 1)
            u = 1 - u, v = 1 - v;
        const glm::dvec3 target =
            glm::dmat4x3(placed) * glm::dvec4(glm::dvec3(p[0]) * (1.0 - double{u} - double{v}) +
                                                  glm::dvec3(p[1]) * double{u} + glm::dvec3(p[2]) * double{v},
                                              1);
        const glm::vec3 origin = glm::vec3(target) + random_direction(random) * between(random, 1, 200);
        const glm::dvec3 way = target - glm::dvec3(origin);
        const Ray ray{origin, glm::vec3(glm::normalize(way)), 1000};
        const auto met = trace::intersect(ray, placed, triangle_of(p));
        ASSERT_TRUE(met);
        const double cosine = std::abs(glm::dot(met->normal, glm::normalize(way))) / glm::length(met->normal);
        if (cosine < 0.02)
            continue;
        // The direction is rounded to single precision.
        const double tolerance = 4e-7 * glm::length(way) / cosine, shortest = glm::length(met->normal) / 20;
        EXPECT_NEAR(met->distance_m, glm::length(way), tolerance);
        EXPECT_NEAR(met->u, u, tolerance / shortest + 1e-6);
        EXPECT_NEAR(met->v, v, tolerance / shortest + 1e-6);
    }
}

TEST(Triangle, PointStaysInsideBesideAnEdge) {
    const Points p = {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
    for (const glm::vec2 beside :
         {glm::vec2(-1e-4f, 0.5f), glm::vec2(0.5f, -1e-4f), glm::vec2(0.6f, 0.6f), glm::vec2(-1, -1)}) {
        const auto met =
            trace::intersect({glm::vec3(beside, 2), {0, 0, -1}, 9}, glm::mat4x3(1), triangle_of(p));
        ASSERT_TRUE(met);
        EXPECT_GE(met->u, 0);
        EXPECT_GE(met->v, 0);
        EXPECT_LE(met->u + met->v, 1);
        EXPECT_EQ(met->distance_m, 2);
    }
    // Almost in the plane, which is met a kilometre behind the triangle: not farther than its corners.
    const auto grazing = trace::intersect({{-5, 0.25f, 1e-6f}, glm::normalize(glm::vec3(1, 0, -1e-9f)), 2000},
                                          glm::mat4x3(1), triangle_of(p));
    ASSERT_TRUE(grazing);
    EXPECT_LE(grazing->distance_m, 6.001);
    EXPECT_FALSE(trace::intersect({{-5, 0.25f, 0}, {1, 0, 0}, 9}, glm::mat4x3(1), triangle_of(p)));
}

// One triangle as an instance, by Embree alone.
class EmbreeTriangle {
  public:
    EmbreeTriangle(RTCDevice device, const Points& points, const glm::mat4x3& placed)
        : mesh_(rtcNewScene(device)), scene_(rtcNewScene(device)) {
        rtcSetSceneFlags(mesh_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry triangle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            triangle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(triangle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 1));
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

    // The hit that is farther from the exact one, of the sides of the line that are asked for.
    [[nodiscard]] RTCRayHit met_by(const Ray& ray) const {
        RTCRayHit farthest{};
        farthest.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        const trace::Sides sides(ray);
        for (int side = 0; side < sides.count; ++side) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            RTCRayHit r;
            trace::set_ray(r, sides.origin(ray, side), ray.direction, 1e30f);
            rtcIntersect1(scene_, &context, &r);
            if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID && r.ray.tfar > farthest.ray.tfar)
                farthest = r;
        }
        return farthest;
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

// Where it is and how it lies: anywhere, stretched, sheared, off its own origin.
glm::mat4x3 any_placement(std::mt19937& random, int n) {
    if (n % 5 == 0)
        return glm::mat4x3(1);
    const auto power = [&](float low, float high) {
        return double{std::pow(10.0f, between(random, low, high))};
    };
    glm::dmat4 m = random_placement(random, static_cast<float>(power(0, 3.9f)), n % 2 == 0);
    if (n % 5 == 2)
        m = glm::scale(m, glm::dvec3(power(-1, 1), power(-1, 1), power(-1, 1)));
    if (n % 5 == 3)
        m[2] += 0.3 * m[0] - 0.2 * m[1];
    return glm::mat4x3(m);
}

TEST(Triangle, EmbreeErrsByLessThanItsBound) {
    const trace::FloatMode float_mode;
    const auto device = trace::Device::open().value();
    std::mt19937 random(17);
    const auto power = [&](float low, float high) { return std::pow(10.0f, between(random, low, high)); };
    double worst_sure = 0, worst_order = 0, max_added = 0;
    int sure = 0, met = 0;
    for (int n = 0; n < 6000; ++n) {
        const float size = power(-2, 2);
        const glm::vec3 pivot = n % 3 == 0 ? random_direction(random) * power(0, 3) : glm::vec3(0);
        Points p;
        for (glm::vec3& corner : p)
            corner = pivot + glm::vec3(between(random, -size, size), between(random, -size, size),
                                       between(random, -size, size) * power(-5, 0));
        glm::mat4x3 placed = any_placement(random, n);
        if (n % 2 == 0)
            placed[3] -= glm::mat3(placed) * pivot;
        const auto shape = trace::instance_shape(placed, 1);
        if (!shape)
            continue;
        const EmbreeTriangle embree(device->handle(), p, placed);
        const float longest =
            std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])}) *
            (1 + 0x1p-20f);
        float farthest = 0;
        for (const glm::vec3& corner : p)
            farthest = std::max({farthest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
        const glm::dmat3 object_from_world = glm::inverse(glm::dmat3(glm::mat3(placed)));
        const trace::Triangle world = trace::transformed(placed, triangle_of(p));
        const glm::dvec3 normal = glm::normalize(glm::cross(world.b - world.a, world.c - world.a)),
                         object_normal = glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]),
                                                    glm::dvec3(p[2]) - glm::dvec3(p[0]));
        for (int k = 0; k < 60; ++k) {
            double u = double{between(random, 0, 1)}, v = double{between(random, 0, 1)};
            if (u + v > 1)
                u = 1 - u, v = 1 - v;
            const glm::dvec3 target = world.a * (1 - u - v) + world.b * u + world.c * v;
            glm::dvec3 direction(random_direction(random));
            direction -= normal * glm::dot(direction, normal) * (1 - double{power(-6, 0)});
            if (k % 10 == 0)
                direction = {0, 0, -1};
            const glm::vec3 origin(target - glm::normalize(direction) * double{power(-1, 3)});
            Ray ray{origin, glm::vec3(glm::normalize(target - glm::dvec3(origin))), 1e5f};
            if (k % 10 == 0)
                ray.direction = {0, 0, -1};
            const RTCRayHit r = embree.met_by(ray);
            const auto at = trace::intersect(ray, placed, triangle_of(p));
            if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID || !at)
                continue;
            ++met;
            const glm::dvec3 object_direction = object_from_world * glm::dvec3(ray.direction);
            const double slack_m = double{trace::query_slack(ray, static_cast<float>(at->distance_m))},
                         order_m = double{trace::order_of(*at, ray, placed, triangle_of(p))};
            const double cosine = std::abs(glm::dot(glm::normalize(at->normal), glm::dvec3(ray.direction)));
            if (trace::is_sure(ray, {r.ray.tfar,
                                     glm::vec3(object_direction),
                                     {r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z},
                                     longest,
                                     farthest,
                                     shape->spread})) {
                ++sure;
                worst_sure = std::max(worst_sure, std::abs(double{r.ray.tfar} - at->distance_m) / slack_m);
                EXPECT_NEAR(order_m, at->distance_m, at->distance_m * 1e-6)
                    << "what is sure is ordered by its distance";
            }
            // Not where the normal is mere rounding.
            const double height = glm::length(object_normal) / double{longest},
                         rounded =
                             double{r.ray.tfar} * glm::length(object_direction) + double{longest + farthest};
            if (std::abs(glm::dot(object_normal, object_direction)) /
                    (glm::length(object_normal) * glm::length(object_direction)) <=
                64 * rounded / height * 0x1p-24)
                continue;
            worst_order = std::max(worst_order, (double{r.ray.tfar} - order_m) / slack_m);
            if (cosine > 0.1)
                max_added = std::max(max_added, order_m - at->distance_m);
        }
    }
    std::printf(
        "sure: off by up to %.3f of the slack; beyond the order by up to %.3f of it; not grazing, up to %.4f "
        "m added; %d of %d sure\n",
        worst_sure, worst_order, max_added, sure, met);
    EXPECT_GT(met, 250000);
    EXPECT_GT(sure, 40000);
    EXPECT_LT(worst_sure, 0.5);
    EXPECT_LT(worst_order, 1);
    EXPECT_LT(max_added, 0.05);
}

}  // namespace
}  // namespace drtv::test
