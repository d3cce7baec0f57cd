// The rays of a bake in the order in which they were traced (but for the few that are looked at twice), so
// that others can be measured on them.
#pragma once

#include "bakerd/bake/ray_watch.h"

#include <vector>

namespace drtv::test {

struct RayLog final : bake::RayWatch {
    std::vector<trace::Ray> paths;
    std::vector<trace::Ray> shadows;

    void begin_probe(const glm::ivec3&) override {}

    void record_segments(std::span<const bake::PathSegment> segments) override {
        for (const bake::PathSegment& segment : segments) {
            const bool again = !paths.empty() && paths.back().origin == segment.ray.origin &&
                               paths.back().direction == segment.ray.direction;
            if (!again)
                paths.push_back(segment.ray);
        }
    }

    void record_shadow_rays(std::span<const bake::ShadowRay> rays) override {
        for (const bake::ShadowRay& shadow : rays)
            shadows.push_back(shadow.ray);
    }
};

}  // namespace drtv::test
