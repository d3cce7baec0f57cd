#include "bakerd/bake/interiors.h"

#include "placement/units.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <vector>

namespace drtv::bake {
namespace {

using placement::Position;

constexpr std::int64_t max_steps = UINT16_MAX;

std::int64_t units(double metres) {
    return std::llround(metres * position_units_per_m);
}

map::SectorCoordinate sector_of(const Position& position) {
    return {placement::sector_of(position.x), placement::sector_of(position.y)};
}

const map::ProbeNode* probe_of(const map::Map& map,
                               const map::VolumeNode& volume,
                               const placement::ClosedVolume& closed,
                               const glm::dvec3& middle) {
    if (!volume.probe_name.empty())
        return &*std::ranges::find(map.probes, volume.probe_name, &map::ProbeNode::name);
    const map::ProbeNode* nearest = nullptr;
    for (const map::ProbeNode& probe : map.probes) {
        if (nearest != nullptr &&
            glm::distance(probe.position, middle) >= glm::distance(nearest->position, middle))
            continue;
        if (closed.contains(probe.position))
            nearest = &probe;
    }
    return nearest;
}

// Vertices that round to one place become one; it keeps every edge's triangles on both sides, so that the
// mesh stays closed.
tl::expected<Interior, std::string> store_mesh(const std::string& name,
                                               const placement::ClosedVolume& closed) {
    const std::vector<glm::dvec3>& vertices = closed.vertices();
    std::array<std::int64_t, 3> low{};
    std::array<std::int64_t, 3> high{};
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const auto [least, most] =
            std::ranges::minmax_element(vertices, {}, [&](const glm::dvec3& v) { return v[axis]; });
        low[k] = units((*least)[axis]);
        high[k] = units((*most)[axis]);
    }
    Interior interior;
    const auto length = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    while (interior.shift < max_interior_shift && (length >> interior.shift) >= max_steps)
        ++interior.shift;
    const auto too_far = [](std::int64_t u) { return std::abs(u) > max_interior_origin_units; };
    if ((length >> interior.shift) >= max_steps || std::ranges::any_of(low, too_far)) {
        return tl::unexpected(
            fmt::format("the interior '{}' is {} m long or lies too far from the origin: the limit is 65 km",
                        name,
                        length / position_units_per_m));
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        interior.origin_units[axis] = static_cast<std::int32_t>(low[axis]);

    std::map<std::array<std::uint16_t, 3>, std::size_t> index_of;
    const auto index = [&](std::uint32_t vertex) {
        std::array<std::uint16_t, 3> steps{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t offset = units(vertices[vertex][static_cast<glm::length_t>(axis)]) - low[axis];
            const std::int64_t half = interior.shift == 0 ? 0 : std::int64_t{1} << (interior.shift - 1);
            steps[axis] = static_cast<std::uint16_t>((offset + half) >> interior.shift);
        }
        const auto [entry, added] = index_of.try_emplace(steps, interior.vertices.size());
        if (added)
            interior.vertices.push_back(steps);
        return entry->second;
    };
    for (const glm::uvec3& triangle : closed.triangles()) {
        const std::array<std::size_t, 3> corners = {index(triangle.x), index(triangle.y), index(triangle.z)};
        if (interior.vertices.size() > max_interior_vertices)
            return tl::unexpected(fmt::format(
                "the interior '{}' has over {} vertices, the limit", name, max_interior_vertices));
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            continue;
        interior.triangles.push_back({static_cast<std::uint16_t>(corners[0]),
                                      static_cast<std::uint16_t>(corners[1]),
                                      static_cast<std::uint16_t>(corners[2])});
    }
    return interior;
}

}  // namespace

tl::expected<InteriorVolume, std::string> make_interior(const map::Map& map,
                                                        const map::VolumeNode& volume,
                                                        const placement::ClosedVolume& closed) {
    auto stored = store_mesh(volume.name, closed);
    if (!stored)
        return tl::unexpected(stored.error());
    glm::dvec3 low = volume.positions.front();
    glm::dvec3 high = low;
    for (const glm::dvec3& position : volume.positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const glm::dvec3 middle = (low + high) / 2.0;
    InteriorVolume interior{volume.name, std::nullopt, {}, closed, std::move(*stored)};
    if (const map::ProbeNode* probe = probe_of(map, volume, closed, middle)) {
        interior.probe = placement::to_position(probe->position);
        interior.sector = sector_of(*interior.probe);
    }
    return interior;
}

std::size_t probe_at(const placement::Position& place, std::span<const placement::Position> positions) {
    const auto squared = [&](const placement::Position& position) {
        return placement::squared_distance(position, place);
    };
    return static_cast<std::size_t>(std::ranges::min_element(positions, {}, squared) - positions.begin());
}

tl::expected<void, std::string> store_interiors(std::span<const InteriorVolume> interiors,
                                                std::span<const placement::Position> positions,
                                                Sector& sector) {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    for (const InteriorVolume& interior : interiors) {
        if (interior.sector != map::SectorCoordinate{sector.i, sector.j} || !interior.probe)
            continue;
        sector.interiors.push_back(interior.stored);
        sector.interiors.back().probe = static_cast<std::uint8_t>(probe_at(*interior.probe, positions));
        vertices += interior.stored.vertices.size();
        triangles += interior.stored.triangles.size();
    }
    if (sector.interiors.size() <= max_interiors && vertices <= max_interiors_vertices &&
        triangles <= max_interior_triangles)
        return {};
    return tl::unexpected(
        fmt::format("sector ({}, {}) has {} interiors with {} vertices and {} triangles, over the limits of "
                    "{}, {} and {}",
                    sector.i,
                    sector.j,
                    sector.interiors.size(),
                    vertices,
                    triangles,
                    max_interiors,
                    max_interiors_vertices,
                    max_interior_triangles));
}

}  // namespace drtv::bake
