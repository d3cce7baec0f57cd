#include "bakerd/bake/local_links.h"

#include <algorithm>
#include <cmath>

namespace drtv::bake {
namespace {

float square(float x) {
    return x * x;
}

}  // namespace

void EndGroup::add(const PathEnd& end) {
    const std::size_t k = ends.size();
    x[k] = end.position.x;
    y[k] = end.position.y;
    z[k] = end.position.z;
    normal_x[k] = end.normal.x;
    normal_y[k] = end.normal.y;
    normal_z[k] = end.normal.z;
    first_x[k] = end.first.x;
    first_y[k] = end.first.y;
    first_z[k] = end.first.z;
    density[k] = end.density;
    density_front[k] = end.density_front;
    density_back[k] = end.density_back;
    to_receiver[k] = end.to_receiver;
    from_light[k] = end.from_light;
    bright_front[k] = end.albedo.x + end.albedo.y + end.albedo.z;
    bright_back[k] = end.beyond ? end.transmitted.x + end.transmitted.y + end.transmitted.z : 0;
    ends.push_back(end);
}

float join(const EndGroup& group, const GroupPaths& paths, const glm::vec3& other, bool own, Links& links) {
    const float scale = 4 / static_cast<float>(paths.count);  // 4 pi of the sphere, over pi of the bounce
    const float in_pairs = own ? 0.0f : 1.0f;
    const float square_reach = square(paths.reach_m);
    for (std::size_t k = 0; k < group_size; ++k) {
        const float x = group.x[k] - other.x;
        const float y = group.y[k] - other.y;
        const float z = group.z[k] - other.z;
        const float first_x = group.first_x[k] - other.x;
        const float first_y = group.first_y[k] - other.y;
        const float first_z = group.first_z[k] - other.z;
        const float facing = -(x * group.normal_x[k] + y * group.normal_y[k] + z * group.normal_z[k]);
        const float squared = std::max(x * x + y * y + z * z, 1e-12f);
        const float inverse = 1 / std::sqrt(squared);
        const float cosine = std::abs(facing) * inverse;
        const float farthest = std::max(squared, first_x * first_x + first_y * first_y + first_z * first_z);
        const float to_there = farthest <= square_reach ? cosine * inverse * inverse * in_pairs : 0.0f;
        const float bright = facing < 0 ? group.bright_back[k] : group.bright_front[k];
        const float density_there = facing < 0 ? group.density_back[k] : group.density_front[k];
        const float density = group.density[k] + to_there * density_there;
        const float over_density = density > 0 ? scale / density : 0.0f;
        const float clamped = std::max(squared, square(local_least_distance_m));
        links.here[k] = group.to_receiver[k] * cosine / clamped * over_density;
        links.there[k] = group.from_light[k] * to_there * over_density;
        links.way_x[k] = x * inverse;
        links.way_y[k] = y * inverse;
        links.way_z[k] = z * inverse;
        links.facing[k] = facing;
        links.strength[k] = links.here[k] * bright;
    }
    float total = 0;
    for (const float strength : links.strength)
        total += strength;
    return total;
}

void add_links(
    const EndGroup& group, const Links& links, bool wants_here, bool wants_there, Brought& brought) {
    LocalCoefficients& here = brought.here[links.partner];
    LocalCoefficients& there = brought.there[links.partner];
    for (std::size_t k = 0; k < group.ends.size(); ++k) {
        if (!(links.strength[k] > 0))
            continue;
        const PathEnd& end = group.ends[k];
        const glm::vec3 on_the_way = links.turns_back ? end.share_back : links.tint;
        const glm::vec3 colours = (links.facing[k] < 0 ? end.transmitted : end.albedo) * on_the_way;
        const Float4 back = irradiance_sh({links.way_x[k], links.way_y[k], links.way_z[k]});
        for (std::size_t c = 0; c < channel_count; ++c) {
            const float colour = colours[static_cast<glm::length_t>(c)];
            for (std::size_t i = 0; wants_here && i < sh_count; ++i)
                here[c][i] += links.here[k] * colour * end.direction[i];
            for (std::size_t i = 0; wants_there && i < sh_count; ++i)
                there[c][i] += links.there[k] * colour * back[i];
        }
    }
}

Float4 irradiance_sh(const glm::vec3& direction) {
    Float4 y = evaluate_sh({direction.x, direction.y, direction.z});
    for (std::size_t i = 1; i < sh_count; ++i)
        y[i] *= 2 / 3.0f;
    return y;
}

}  // namespace drtv::bake
