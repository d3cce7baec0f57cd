#include "bakerd/map/mesh_placement.h"

#include "bakerd/map/content_digest.h"
#include "bakerd/map/named_groups.h"
#include "bakerd/map/warning.h"

#include <fmt/format.h>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace drtv::map {
namespace {

// Objects, vertices that their bounds must visit, and vertices that volumes and flattened meshes copy.
constexpr std::size_t max_objects = std::size_t{1} << 22;
constexpr std::size_t max_placed_vertices = std::size_t{1} << 32;
constexpr std::size_t max_copied_vertices = std::size_t{1} << 26;

// So flat that the inverse which instancing needs does not exist.
bool is_flat(const glm::dmat4& world_from_object) {
    const glm::dmat3 linear(world_from_object);
    const double volume = std::abs(glm::determinant(linear));
    const double side = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    return volume <= 1e-9 * side * side * side;
}

// By vertices as they are placed; false where one of them is far. Most of a large map's import.
bool extend(Bounds& bounds, std::span<const glm::vec3> positions, const glm::mat4x3& placed) {
    glm::vec3 nothing(0);  // NaN where a vertex is, which bounds would not show
    for (const glm::vec3& position : positions) {
        const glm::vec3 corner = placed * glm::vec4(position, 1);
        bounds.extend(corner);
        nothing += 0.0f * corner;
    }
    constexpr auto near_m = static_cast<float>(max_distance_m / 2);  // along each axis
    if (nothing == glm::vec3(0) && glm::all(glm::lessThan(bounds.high, glm::vec3(near_m))) &&
        glm::all(glm::greaterThan(bounds.low, glm::vec3(-near_m))))
        return true;
    return std::ranges::none_of(
        positions, [&](const glm::vec3& position) { return is_far(placed * glm::vec4(position, 1)); });
}

}  // namespace

bool shines(const Mesh& mesh, const Map& map) {
    return std::ranges::any_of(mesh.primitives, [&](const Primitive& primitive) {
        return map.materials[primitive.material].emission != glm::vec3(0);
    });
}

bool is_far(const glm::dvec3& position) {
    return !(glm::length(position) < max_distance_m);
}

Imported MeshPlacer::count(std::uint32_t mesh, const NodePurpose& purpose, std::size_t instances) {
    if (is_volume(purpose.role) || purpose.spacing_m > 0) {
        if (auto counted = count_copied(mesh, instances); !counted || is_volume(purpose.role))
            return counted;
    }
    placed_vertices_ += instances * vertices_of(mesh);
    if (map_.objects.size() + instances > max_objects)
        return tl::unexpected(
            fmt::format("with its instances the map has over {} objects, the limit", max_objects));
    if (placed_vertices_ > max_placed_vertices)
        return tl::unexpected(
            fmt::format("with its instances the file places {} vertices, over the limit of {}",
                        placed_vertices_,
                        max_placed_vertices));
    return {};
}

Imported MeshPlacer::place(MeshPlace place, const NodePurpose& purpose) {
    if (purpose.spacing_m > 0) {
        VolumeNode volume;
        volume.kind = VolumeKind::spacing;
        volume.spacing_m = purpose.spacing_m;
        auto added = add_volume(place, std::move(volume));
        if (!added || purpose.role == NodeRole::spacing)
            return added;
    }
    if (!is_volume(purpose.role))
        return add_object(std::move(place), purpose);
    VolumeNode volume;
    if (purpose.role == NodeRole::interior) {
        volume.kind = VolumeKind::interior;
        volume.probe_name = purpose.bake_probe;
    }
    return add_volume(place, std::move(volume));
}

std::size_t MeshPlacer::vertices_of(std::uint32_t mesh) const {
    std::size_t vertices = 0;
    for (const Primitive& primitive : map_.meshes[mesh].primitives)
        vertices += primitive.positions.size();
    return vertices;
}

Imported MeshPlacer::count_copied(std::uint32_t mesh, std::size_t instances) {
    copied_vertices_ += instances * vertices_of(mesh);
    if (copied_vertices_ <= max_copied_vertices)
        return {};
    return tl::unexpected(
        fmt::format("volumes and flat objects up to it have {} vertices, over the limit of {}",
                    copied_vertices_,
                    max_copied_vertices));
}

std::uint32_t MeshPlacer::flattened_mesh(std::uint32_t mesh, const glm::mat4x3& world_from_object) {
    Mesh flat = map_.meshes[mesh];
    flat.bounds = {};
    for (Primitive& primitive : flat.primitives) {
        for (glm::vec3& position : primitive.positions) {
            position = world_from_object * glm::vec4(position, 1) + 0.0f;
            flat.bounds.extend(position);
        }
        primitive.digest = digest_primitive(primitive, map_);
    }
    flat.digest = digest_mesh(flat);
    return keep_once(std::move(flat), map_.meshes, shared_.meshes);
}

Imported MeshPlacer::add_object(MeshPlace place, const NodePurpose& purpose) {
    Object object;
    object.mesh = place.mesh;
    object.role = purpose.role == NodeRole::vegetation ? Role::vegetation : Role::fixed;
    object.world_from_object = glm::mat4x3(glm::dmat4x3(place.world_from_object));
    object.name = as_sentence(std::move(place.name));  // it is shown to people
    if (is_flat(place.world_from_object)) {
        // The surface gets a mesh of its own.
        if (auto counted = count_copied(place.mesh, 1); !counted)
            return counted;
        object.mesh = flattened_mesh(place.mesh, object.world_from_object);
        object.world_from_object = glm::mat4x3(1);
    }
    for (const Primitive& primitive : map_.meshes[object.mesh].primitives) {
        if (!extend(object.bounds, primitive.positions, object.world_from_object))
            return tl::unexpected(std::string(far_sentence));
    }
    if (shines(map_.meshes[object.mesh], map_))
        object.light_group = light_group_of(purpose.light_group, map_);
    object.digest = digest_object(object, map_);
    map_.objects.push_back(std::move(object));
    return {};
}

Imported MeshPlacer::add_volume(const MeshPlace& place, VolumeNode volume) {
    volume.name = place.name;
    volume.where = as_sentence(place.where);
    for (const Primitive& primitive : map_.meshes[place.mesh].primitives) {
        const auto first = static_cast<std::uint32_t>(volume.positions.size());
        for (const glm::vec3& position : primitive.positions) {
            const glm::dvec3 corner(place.world_from_object * glm::dvec4(position, 1));
            volume.positions.push_back(corner + 0.0);  // no negative zeros
            if (is_far(corner))
                return tl::unexpected(std::string(far_sentence));
        }
        for (const glm::uvec3& triangle : primitive.triangles)
            volume.triangles.push_back(triangle + first);
    }
    volume.digest = digest_volume(volume);
    map_.volumes.push_back(std::move(volume));
    return {};
}

}  // namespace drtv::map
