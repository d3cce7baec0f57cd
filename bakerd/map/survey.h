// What a map holds, as somebody who hands it in would check it.
#pragma once

#include "bakerd/map/map.h"

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

struct Survey {
    glm::vec3 low{0};  // of the objects, world metres; all 0 without objects
    glm::vec3 high{0};
    std::int64_t static_objects = 0;
    std::int64_t vegetation_objects = 0;
    std::int64_t ignored_nodes = 0;  // with a bake_role 'ignore' of their own
    std::int64_t triangles = 0;      // of the objects, instances counted
    std::int64_t lamps = 0;          // point and spot lights
    std::int64_t suns = 0;           // directional lights
    std::int64_t glowing_objects = 0;
    std::int64_t probes = 0;  // hand-placed
    std::int64_t interiors = 0;
    std::int64_t probe_free_volumes = 0;
    std::int64_t spacing_volumes = 0;
    // Seen from above and from below: area of static one-sided surfaces, projected to the ground, m2. A
    // double-sided one faces both ways.
    double up_m2 = 0;
    double down_m2 = 0;
    // Of the 32 objects with the smallest digests, 16 hexadecimal digits each (MinHash, Broder 1997):
    // versions of one map share some, different maps none.
    std::string likeness;
};

// Hands each value with its name to `codec`, which reads or writes them all.
void visit_values(auto& codec, auto& survey) {
    codec("x0", survey.low.x);
    codec("y0", survey.low.y);
    codec("z0", survey.low.z);
    codec("x1", survey.high.x);
    codec("y1", survey.high.y);
    codec("z1", survey.high.z);
    codec("static_objects", survey.static_objects);
    codec("vegetation_objects", survey.vegetation_objects);
    codec("ignored_nodes", survey.ignored_nodes);
    codec("triangles", survey.triangles);
    codec("lamps", survey.lamps);
    codec("suns", survey.suns);
    codec("glowing_objects", survey.glowing_objects);
    codec("probes", survey.probes);
    codec("interiors", survey.interiors);
    codec("probe_free_volumes", survey.probe_free_volumes);
    codec("spacing_volumes", survey.spacing_volumes);
    codec("up_m2", survey.up_m2);
    codec("down_m2", survey.down_m2);
    codec("likeness", survey.likeness);
}

[[nodiscard]] Survey survey_of(const Map& map);

// Sentences about what an artist hardly meant: a map in other units than metres, on its side or inside out.
[[nodiscard]] std::vector<std::string> doubts_about(const Survey& survey);

// Fails where no probe can stand anywhere in a map that has objects: nothing in it faces up.
[[nodiscard]] tl::expected<void, std::string> check_survey(const Survey& survey);

}  // namespace drtv::map
