#include "bakerd/map/survey.h"

#include "bakerd/map/mesh_placement.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::map {
namespace {

constexpr const char* remedy =
    "is it on its side, or inside out? (in Blender: Mesh > Normals > Recalculate Outside; export with +Y up)";

void add_areas(const Object& object, const Map& map, Survey& survey) {
    // The winding of the object's own axes tells the front, also where the object mirrors.
    const glm::mat3 linear(object.world_from_object);
    const double side = glm::determinant(linear) < 0 ? -1 : 1;
    for (const Primitive& primitive : map.meshes[object.mesh].primitives) {
        const bool double_sided = map.materials[primitive.material].double_sided;
        for (const glm::uvec3& triangle : primitive.triangles) {
            const glm::vec3 a = linear * primitive.positions[triangle.x];
            const glm::vec2 b = glm::vec2(linear * primitive.positions[triangle.y] - a);
            const glm::vec2 c = glm::vec2(linear * primitive.positions[triangle.z] - a);
            const double twice = side * static_cast<double>(b.x * c.y - b.y * c.x);
            if (double_sided || twice > 0)
                survey.up_m2 += std::abs(twice) / 2;
            if (double_sided || twice < 0)
                survey.down_m2 += std::abs(twice) / 2;
        }
    }
}

void add_object(const Object& object, const Map& map, Survey& survey) {
    const bool is_vegetation = object.role == Role::vegetation;
    ++(is_vegetation ? survey.vegetation_objects : survey.static_objects);
    for (const Primitive& primitive : map.meshes[object.mesh].primitives)
        survey.triangles += static_cast<std::int64_t>(primitive.triangles.size());
    if (shines(map.meshes[object.mesh], map))
        ++survey.glowing_objects;
    if (!is_vegetation)
        add_areas(object, map, survey);
}

// REQUIRES: the objects are sorted by digest.
std::string likeness_of(const Map& map) {
    constexpr std::size_t max_objects = 32;
    constexpr std::size_t digits = 16;
    std::string likeness;
    std::size_t count = 0;
    const Digest* last = nullptr;
    for (const Object& object : map.objects) {
        if (last != nullptr && *last == object.digest)
            continue;
        last = &object.digest;
        likeness += to_hex(object.digest).substr(0, digits);
        if (++count == max_objects)
            break;
    }
    return likeness;
}

}  // namespace

Survey survey_of(const Map& map) {
    Survey survey;
    Bounds bounds;
    for (const Object& object : map.objects) {
        bounds.extend(object.bounds.low);
        bounds.extend(object.bounds.high);
        add_object(object, map, survey);
    }
    if (!bounds.empty()) {
        survey.low = bounds.low;
        survey.high = bounds.high;
    }
    for (const Light& light : map.lights)
        ++(light.kind == LightKind::directional ? survey.suns : survey.lamps);
    for (const VolumeNode& volume : map.volumes) {
        if (volume.kind == VolumeKind::interior)
            ++survey.interiors;
        else
            ++(volume.kind == VolumeKind::no_probes ? survey.probe_free_volumes : survey.spacing_volumes);
    }
    survey.likeness = likeness_of(map);
    survey.ignored_nodes = map.ignored_nodes;
    survey.probes = static_cast<std::int64_t>(map.probes.size());
    return survey;
}

std::vector<std::string> doubts_about(const Survey& survey) {
    constexpr float small_m = 4;
    constexpr float large_m = 10'000;
    constexpr float tall_m = 128;
    constexpr float side_m = 20;  // smaller things may stand upright, as a tower does
    constexpr double often = 2;
    std::vector<std::string> doubts;
    if (survey.triangles == 0)
        return doubts;
    const glm::vec3 size = survey.high - survey.low;
    const float side = std::max(size.x, size.y);
    if (side < small_m)
        doubts.push_back(
            fmt::format("the map is only {:.3g} m across: was it made in metres? A sector is 64 m", side));
    if (side > large_m)
        doubts.push_back(
            fmt::format("the map is {:.1f} km across: was it made in metres? A sector is 64 m", side / 1000));
    // Of a map that lies as it should the ground faces up, however tall it is.
    const bool is_sideways = size.z > side_m && size.z > 2 * std::min(size.x, size.y) &&
                             survey.up_m2 < double{size.z} * double{side} / 4;
    if (is_sideways || (size.z > tall_m && size.z > side))
        doubts.push_back(
            fmt::format("the map is {:.0f} m across and {:.0f} m tall: {}", side, size.z, remedy));
    else if (survey.down_m2 > often * survey.up_m2)
        doubts.push_back(fmt::format("{:.0f} m2 of the map's surfaces face down, and {:.0f} m2 face up: {}",
                                     survey.down_m2,
                                     survey.up_m2,
                                     remedy));
    return doubts;
}

tl::expected<void, std::string> check_survey(const Survey& survey) {
    const bool has_objects = survey.static_objects > 0;
    if (!has_objects || survey.up_m2 > 0 || survey.vegetation_objects > 0 || survey.probes > 0)
        return {};
    return tl::unexpected(
        fmt::format("no surface of the map faces up, so no probe can stand on it: {}", remedy));
}

}  // namespace drtv::map
