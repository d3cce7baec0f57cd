// The filters by which the hits that Embree offers are accepted. REQUIRES: they are used within a Query.
#pragma once

struct RTCFilterFunctionNArguments;

namespace drtv::trace {

// Keeps the closest hit, and of several at the same distance the one of the smallest id: neither the order in
// which the BVH offers them nor Embree's rounding matters.
void intersect_filter(const RTCFilterFunctionNArguments* args);

void occluded_filter(const RTCFilterFunctionNArguments* args);

}  // namespace drtv::trace
