// The runtime's ambient light beside the path-traced truth, with the errors of storage, shading and
// interpolation told apart.
#pragma once

#include "tests/ambient/ambient_errors.h"
#include "tests/ambient/moments.h"
#include "tests/reference/reference_ambient.h"

#include <drtv/sector_set.h>

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drtv::test {

struct JudgeSettings {
    std::size_t probes = 60;    // spread over all sectors
    std::size_t surfaces = 60;  // places that the probes see, within 30 m
    std::uint32_t strata = 48;  // strata^2 paths for each place
    std::uint32_t bounces = 3;
    double reach_m = 512;
    glm::dvec3 low{-1e9}, high{1e9};  // probes between, surfaces that these see
    std::uint64_t seed = 1;
    unsigned threads = 2;  // they do not change the numbers
};

struct Judgement {
    std::vector<Errors> at_probes;    // over 64 normals all around
    std::vector<Errors> at_surfaces;  // at the surface's normal
    // Share of each part in the truth, at probes: sky direct, sky bounce, sun bounce, static.
    std::vector<std::pair<std::string, double>> parts;
};

// Places whose truth is darker than 1/1000 are left out. REQUIRES: the set holds sectors of this scene.
[[nodiscard]] Judgement judge_ambient(const reference::Scene& scene, const SectorSet& set,
                                      std::span<const LoadedSector* const> sectors,
                                      std::span<const TestMoment> moments, const JudgeSettings& settings);

void print(const Judgement& judgement);

}  // namespace drtv::test
