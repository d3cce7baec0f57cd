// The first rays of a sector's probes: which of them reach the boxes of a change. They need no record, since
// they follow from where the probes stand.
#pragma once

#include "bakerd/bake/sampling.h"
#include "bakerd/reuse/boxes.h"
#include "bakerd/reuse/footprint.h"
#include "bakerd/trace/scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv::reuse {

class FirstRays {
  public:
    // Of the footprint's probes, each with its shift of the samples. REQUIRES: all three outlive it.
    FirstRays(const Footprint& footprint, const bake::SampleTable& samples, const trace::Scene& scene);

    // The weight of the rays of a probe that go into one of the boxes. Above 0 when there
    // are such rays at all. REQUIRES: what changed lies inside the boxes.
    [[nodiscard]] float weight_of(std::size_t probe, std::span<const Bounds> boxes) const;

  private:
    // Part of the plane of sample numbers.
    struct Square {
        float x0 = 1;
        float x1 = 0;
        float y0 = 1;
        float y1 = 0;
    };
    struct Probe {
        glm::vec3 place{};
        std::array<std::uint32_t, bake::max_sample_dimensions> shift{};
        std::vector<Square> groups;  // what the samples of each group span
    };
    struct Window;

    [[nodiscard]] static Window window_of(const glm::vec3& from, const Bounds& box);
    [[nodiscard]] float farthest_m() const;
    [[nodiscard]] bool may_come_to(const trace::Ray& ray, float enter_m) const;
    [[nodiscard]] std::span<const std::uint32_t> members(std::size_t group) const;
    [[nodiscard]] glm::vec3 direction_of(const Probe& probe, std::uint32_t sample) const;

    const Footprint& footprint_;
    const bake::SampleTable& samples_;
    const trace::Scene& scene_;
    std::vector<Probe> probes_;
};

}  // namespace drtv::reuse
