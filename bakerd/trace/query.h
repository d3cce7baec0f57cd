// What a filter function and its caller share during one query.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

namespace drtv::trace {

// Which triangle, in Embree's numbers: instance in the scene, triangle set of its mesh, triangle of the set. All three
// follow the order of the content (TriangleSet), so that the smaller one does too.
struct TriangleId {
    std::uint32_t instance = 0, set = 0, triangle = 0;
    bool operator<(const TriangleId& o) const { return std::tie(instance, set, triangle) < std::tie(o.instance, o.set, o.triangle); }
    bool operator==(const TriangleId&) const = default;
};

struct Crossing {
    float distance = 0;
    TriangleId id;
    float facing = 0;  // direction . normal in object space: negative is the front
};

// REQUIRES: `base` stays the first member, Embree hands back a pointer to it.
struct Query {
    RTCIntersectContext base;
    float best_distance = std::numeric_limits<float>::infinity();
    TriangleId best;
    std::vector<Crossing>* crossings = nullptr;  // collect every hit instead of the closest

    Query() { rtcInitIntersectContext(&base); }
};

}  // namespace drtv::trace
