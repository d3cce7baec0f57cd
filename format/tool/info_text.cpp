#include "info_text.h"

#include <array>
#include <cstdio>

namespace drtv::tool {
namespace {

// Wide enough for each line below.
using Line = std::array<char, 200>;

}  // namespace

std::string settings_text(const BakeRecord& bake) {
    Line text{};
    std::snprintf(text.data(),
                  text.size(),
                  "rays %u, bounces %u, reach %g m, min_distance %g m",
                  bake.rays,
                  bake.bounces,
                  static_cast<double>(bake.reach_m),
                  static_cast<double>(bake.min_distance_m));
    return text.data();
}

std::string placement_text(const Statistics& statistics) {
    Line text{};
    std::snprintf(
        text.data(),
        text.size(),
        "%u candidates, %u moved out of solids, %u dropped in solids, %u removed by volumes, %u thinned",
        statistics.candidates,
        statistics.moved_out,
        statistics.dropped_in_solid,
        statistics.removed_by_volume,
        statistics.thinned);
    return text.data();
}

std::string rays_text(const Statistics& statistics) {
    Line text{};
    std::snprintf(text.data(),
                  text.size(),
                  "%llu, of which %llu met the back of a one-sided surface",
                  static_cast<unsigned long long>(statistics.rays),
                  static_cast<unsigned long long>(statistics.back_hits));
    return text.data();
}

}  // namespace drtv::tool
