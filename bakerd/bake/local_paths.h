// Paths from one source of local transfer.
#pragma once

#include "bakerd/bake/local_links.h"
#include "bakerd/bake/local_transfer.h"
#include "bakerd/bake/ray_watch.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/trace/scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace drtv::bake {

// Nothing less is known of what a ray of local transfer may change.
inline constexpr Shares whole_range = {1, 1, 1, 1};

struct LocalPathStart {
    const trace::Scene& scene;
    const SampleTable& samples;
    const LocalSettings& settings;
    const glm::vec3& source;  // metres
    const std::array<std::uint32_t, max_sample_dimensions>& shift;
};

// Traces the path of that number and adds its ends to the groups, one for each number of bounces. Gives the
// number of rays.
std::uint64_t trace_local_path(const LocalPathStart& start,
                               std::uint32_t number,
                               std::span<EndGroup> groups,
                               RayWatch* watch);

}  // namespace drtv::bake
