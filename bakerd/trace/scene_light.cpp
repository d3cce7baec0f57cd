// What comes along a ray: whether something hides its end, and what glass takes of the light.
#include "bakerd/trace/query.h"
#include "bakerd/trace/scene.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace drtv::trace {

void Scene::occluded(std::span<const Ray> rays, std::vector<bool>& answers) const {
    Query query(*this, rays);
    query.base.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    thread_local std::vector<RTCRay> stream;
    stream.resize(rays.size());
    for (std::size_t n = 0; n < rays.size(); ++n)
        set_ray(stream[n],
                rays[n].origin,
                rays[n].direction,
                rays[n].far_m + query_slack(rays[n], rays[n].far_m),
                static_cast<unsigned>(n));
    rtcOccluded1M(handle_, &query.base, stream.data(), static_cast<unsigned>(stream.size()), sizeof(RTCRay));
    answers.clear();
    for (std::size_t n = 0; n < rays.size(); ++n)
        answers.push_back(stream[n].tfar < 0 || (Sides(rays[n]).count > 1 && occluded(rays[n])));
}

// Of an edge that two triangles of a pane share, one of them counts.
std::vector<Crossing> Scene::panes(const Ray& ray, Collected wanted, bool to_surface) const {
    std::vector<Crossing> panes;
    for (const Crossing& crossing : all_crossings(ray, wanted)) {
        const auto is_the_same = [&](const Crossing& other) {
            return other.id.instance == crossing.id.instance && other.id.set == crossing.id.set &&
                   glm::dot(other.at.normal, crossing.at.normal) > 0 &&
                   in_one_plane(ray, other.at, crossing.at);
        };
        const bool at_end =
            to_surface && holds_end(ray, set_of(crossing.id.instance, crossing.id.set), crossing, *this);
        if (!at_end && std::ranges::none_of(panes, is_the_same))
            panes.push_back(crossing);
    }
    return panes;
}

GlassPassed Scene::passed(const Ray& ray, bool to_surface) const {
    GlassPassed passed;
    if (!kinds_.glass)
        return passed;
    for (const Crossing& pane : panes(ray, Collected::through_glass, to_surface)) {
        const GlassPassed once =
            passed_glass_at(point_of(set_of(pane.id.instance, pane.id.set), pane.id.triangle, pane.at));
        passed.tint *= once.tint;
        passed.share *= once.share;
    }
    return passed;
}

glm::vec3 Scene::share_seen(const Ray& ray, bool to_surface) const {
    Query query(*this, {&ray, 1});
    query.to_surface = to_surface;
    query.by_chance = false;
    if (is_met(query, ray) || (query.ends_on_back && ends_behind(ray)))
        return glm::vec3(0);
    glm::vec3 share(1);
    if (!kinds_.partly_there)
        return share;
    for (const Crossing& pane : panes(ray, Collected::partly_there, to_surface))
        share *= passed_at(point_of(set_of(pane.id.instance, pane.id.set), pane.id.triangle, pane.at));
    return share;
}

// Whether a front lies in the plane of the back.
bool Scene::is_covered(const Crossing& back, const std::vector<Crossing>& crossings, const Ray& ray) const {
    return std::ranges::any_of(crossings, [&](const Crossing& other) {
        return meets_front(other.id.instance, other.at, ray) && in_one_plane(ray, back.at, other.at);
    });
}

std::size_t Scene::crossings(const Ray& ray) const {
    const std::vector<Crossing> crossings = all_crossings(ray, Collected::there);
    // Of a front and a back in one plane the front alone counts.
    const auto makes_way = [&](const Crossing& back) {
        return !meets_front(back.id.instance, back.at, ray) && is_covered(back, crossings, ray);
    };
    return crossings.size() - static_cast<std::size_t>(std::ranges::count_if(crossings, makes_way));
}

bool Scene::occluded(const Ray& ray) const {
    Query query(*this, {&ray, 1});
    return is_met(query, ray);
}

bool Scene::hides_surface(const Ray& ray) const {
    Query query(*this, {&ray, 1});
    query.to_surface = true;
    return is_met(query, ray) || (query.ends_on_back && ends_behind(ray));
}

// Whether what the ray ends on turns a blind back to it.
bool Scene::ends_behind(const Ray& ray) const {
    // A front in the same plane may lie beyond the end, by rounding.
    const Ray longer{ray.origin, ray.direction, ray.far_m + plane_slack(ray, ray.far_m)};
    const std::vector<Crossing> crossings = all_crossings(longer, Collected::there);
    return std::ranges::any_of(crossings, [&](const Crossing& crossing) {
        const TriangleSet& set = set_of(crossing.id.instance, crossing.id.set);
        return !meets_front(crossing.id.instance, crossing.at, ray) &&
               !is_two_sided(*set.material, instances_[crossing.id.instance].role) &&
               holds_end(ray, set, crossing, *this) && !is_covered(crossing, crossings, ray);
    });
}

bool Scene::is_met(Query& query, const Ray& ray) const {
    const Sides sides(ray);
    for (int side = 0; side < sides.count; ++side) {
        RTCRay r;
        set_ray(r, sides.origin(ray, side), ray.direction, ray.far_m + query_slack(ray, ray.far_m));
        rtcOccluded1(handle_, &query.base, &r);
        if (r.tfar < 0)
            return true;
    }
    return false;
}

}  // namespace drtv::trace
