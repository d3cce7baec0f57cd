#include "bakerd/bake/world.h"

#include "bakerd/bake/integrate.h"
#include "bakerd/bake/tile.h"
#include "placement/units.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <set>

namespace drtv::bake {
namespace {

// Sectors come tile by tile; two tiles are at work while one ends and the next begins, and up to four around
// a change.
constexpr std::size_t kept_scenes = 4;

// Two rows of tiles side by side; a placement is some kilobytes.
constexpr std::size_t kept_placements = 1024;

// Those of the paths and of local transfer, of two jobs at once.
constexpr std::size_t kept_samples = 4;

const char* name_of(map::VolumeKind kind) {
    switch (kind) {
        case map::VolumeKind::no_probes:
            return "of the bake_role 'no_probes'";
        case map::VolumeKind::interior:
            return "of the bake_role 'interior'";
        case map::VolumeKind::spacing:
            return "with a bake_spacing";
    }
    return "";
}

}  // namespace

World::World(std::shared_ptr<const trace::Device> device,
             const std::shared_ptr<const map::Map>& map,
             std::shared_ptr<trace::MeshShelf> shelf)
    : geometry_(std::move(device), map, std::move(shelf)),
      lights_(map),
      max_scattered_(lights_.empty() ? trace::min_scattered : trace::max_scattered(*map)),
      scenes_(kept_scenes),
      placements_(kept_placements),
      samples_(kept_samples) {}

tl::expected<std::shared_ptr<World>, std::string> World::open(std::shared_ptr<const trace::Device> device,
                                                              std::shared_ptr<const map::Map> map,
                                                              std::shared_ptr<trace::MeshShelf> shelf) {
    constexpr std::size_t max_emissive = std::size_t{1} << 23;  // triangles: half a gigabyte
    if (const std::size_t count = emissive_triangles(*map); count > max_emissive) {
        return tl::unexpected(fmt::format(
            "the map's emissive surfaces have {} triangles, instances counted, over the limit of {}",
            count,
            max_emissive));
    }
    std::shared_ptr<World> world(new World(std::move(device), std::move(map), std::move(shelf)));
    auto sectors = map::sectors_of(world->map());
    if (!sectors)
        return tl::unexpected(sectors.error());
    world->sectors_ = std::move(*sectors);
    if (auto opened = world->open_volumes(); !opened)
        return tl::unexpected(opened.error());
    if (auto checked = world->check_spacings(); !checked)
        return tl::unexpected(checked.error());
    world->tag_probes();
    return world;
}

tl::expected<void, std::string> World::open_volumes() {
    for (const map::VolumeNode& volume : map().volumes) {
        auto closed = placement::ClosedVolume::make(volume.positions, volume.triangles);
        if (!closed)
            return tl::unexpected(
                fmt::format("{}: its mesh, {}, {}", volume.where, name_of(volume.kind), closed.error()));
        switch (volume.kind) {
            case map::VolumeKind::no_probes:
                tags_.no_probes.push_back(std::move(*closed));
                break;
            case map::VolumeKind::spacing:
                tags_.spacings.push_back({std::move(*closed), volume.spacing_m});
                break;
            case map::VolumeKind::interior: {
                auto interior = make_interior(map(), volume, *closed);
                if (!interior)
                    return tl::unexpected(interior.error());
                if (!interior->probe)
                    warnings_.push_back(fmt::format(
                        "the interior '{}' names no probe and no probe node is inside it: no file holds it",
                        interior->name));
                interiors_.push_back(std::move(*interior));
            }
        }
    }
    return {};
}

// Every distance makes placement look farther around each sector.
tl::expected<void, std::string> World::check_spacings() const {
    constexpr std::size_t max_distances = 8;
    std::set<float> distances;
    for (const placement::SpacingVolume& spacing : tags_.spacings)
        distances.insert(spacing.min_distance_m);
    if (distances.size() <= max_distances)
        return {};
    return tl::unexpected(
        fmt::format("the map's bake_spacing volumes keep {} different distances, over the limit of {}",
                    distances.size(),
                    max_distances));
}

void World::tag_probes() {
    for (const map::ProbeNode& probe : map().probes) {
        placement::HandPlacedProbe tagged{probe.position, {}};
        for (const InteriorVolume& interior : interiors_) {
            if (interior.probe == placement::to_position(probe.position))
                tagged.interiors.push_back(&interior.volume);
        }
        tags_.manual_probes.push_back(std::move(tagged));
    }
}

std::shared_ptr<const trace::Scene> World::scene_for(map::SectorCoordinate sector, float distance_m) {
    const map::SectorCoordinate tile = tile_of(sector);
    // Isolated, because a thread that helps out while it waits for the build could otherwise take up another
    // sector of this tile and wait for itself.
    return *scenes_.get({tile, distance_m}, [&] {
        return tbb::this_task_arena::isolate([&] {
            constexpr float side_m = tile_sectors * static_cast<float>(map::sector_size_m);
            const glm::vec2 corner = glm::vec2(tile.i, tile.j) * side_m;
            return trace::Scene::build(geometry_, {corner, corner + side_m}, distance_m);
        });
    });
}

bool World::has_sector(map::SectorCoordinate sector) const {
    return std::ranges::binary_search(
        sectors_, std::pair(sector.j, sector.i), {}, [](const map::SectorCoordinate& s) {
            return std::pair(s.j, s.i);
        });
}

std::shared_ptr<const Placed> World::placed(map::SectorCoordinate sector,
                                            const settings::BakeSettings& settings,
                                            const trace::Scene& scene) {
    return placements_.get({sector, settings.reach_m, settings.min_distance_m},
                           [&] { return place_sector(tags_, scene, sector, settings); });
}

Surroundings World::surroundings(map::SectorCoordinate sector, const settings::BakeSettings& settings) {
    return {scene_for(sector, scene_distance_m(tags_, settings)),
            samples(settings.rays, sample_dimensions(settings.bounces, !lights_.empty()))};
}

std::shared_ptr<const SampleTable> World::samples(std::uint32_t count, std::uint32_t dimensions) {
    return samples_.get({count, dimensions}, [&] { return SampleTable(count, dimensions); });
}

}  // namespace drtv::bake
