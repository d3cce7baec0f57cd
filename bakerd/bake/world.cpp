#include "bakerd/bake/world.h"

#include "bakerd/bake/integrate.h"
#include "bakerd/bake/tile.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace drtv::bake {
namespace {

// Sectors come tile by tile; two tiles are at work while one ends and the next begins.
constexpr std::size_t kept_scenes = 2;

// Two rows of tiles side by side; a placement is some kilobytes.
constexpr std::size_t kept_placements = 1024;

}  // namespace

tl::expected<std::shared_ptr<World>, std::string> World::open(std::shared_ptr<const trace::Device> device, std::shared_ptr<const map::Map> map) {
    constexpr std::size_t most_emissive = std::size_t{1} << 23;  // triangles: half a gigabyte
    if (const std::size_t count = emissive_triangles(*map); count > most_emissive) {
        return tl::unexpected(fmt::format("the map's emissive surfaces have {} triangles, instances counted, over the limit of {}", count, most_emissive));
    }
    std::shared_ptr<World> world(new World(std::move(device), std::move(map)));
    auto sectors = map::sectors_with_ground(world->map());
    if (!sectors) return tl::unexpected(sectors.error());
    world->sectors_ = std::move(*sectors);
    for (const map::Volume& volume : world->map().volumes) {
        auto closed = placement::ClosedVolume::make(volume.name, volume.positions, volume.triangles);
        if (!closed) return tl::unexpected(closed.error());
        if (volume.kind == map::VolumeKind::no_probes) world->no_probes_.push_back(std::move(*closed));
    }
    for (const map::ManualProbe& probe : world->map().probes) world->manual_probes_.push_back(probe.position);
    return world;
}

std::shared_ptr<const trace::Scene> World::scene_for(map::SectorCoordinate sector, float distance_m) {
    const map::SectorCoordinate tile = tile_of(sector);
    CachedScene entry;
    {
        const std::lock_guard lock(mutex_);
        const auto found = std::find_if(scenes_.begin(), scenes_.end(), [&](const CachedScene& s) { return s.tile == tile && s.distance_m == distance_m; });
        if (found != scenes_.end()) scenes_.splice(scenes_.begin(), scenes_, found);
        else scenes_.push_front({tile, distance_m, std::make_shared<std::once_flag>(), std::make_shared<std::shared_ptr<const trace::Scene>>()});
        while (scenes_.size() > kept_scenes) scenes_.pop_back();
        entry = scenes_.front();
    }
    // Built outside the lock: other tiles need not wait. Isolated, because a thread that helps out while it waits
    // for the build could otherwise take up another sector of this tile and wait for itself.
    std::call_once(*entry.built, [&] {
        tbb::this_task_arena::isolate([&] {
            constexpr float side_m = tile_sectors * static_cast<float>(map::sector_size_m);
            const glm::vec2 corner = glm::vec2(tile.i, tile.j) * side_m;
            *entry.scene = trace::Scene::build(geometry_, {corner, corner + side_m}, distance_m);
        });
    });
    return *entry.scene;
}

bool World::has_ground(map::SectorCoordinate sector) const {
    return std::ranges::binary_search(sectors_, std::pair(sector.j, sector.i), {}, [](const map::SectorCoordinate& s) { return std::pair(s.j, s.i); });
}

std::shared_ptr<const Placed> World::placed(map::SectorCoordinate sector, const Settings& settings, const trace::Scene& scene) {
    CachedPlacement entry;
    {
        const std::lock_guard lock(mutex_);
        const auto found = std::find_if(placements_.begin(), placements_.end(), [&](const CachedPlacement& p) { return p.sector == sector && p.reach_m == settings.reach_m && p.min_distance_m == settings.min_distance_m; });
        if (found != placements_.end()) placements_.splice(placements_.begin(), placements_, found);
        else placements_.push_front({sector, settings.reach_m, settings.min_distance_m, std::make_shared<std::once_flag>(), std::make_shared<Placed>()});
        while (placements_.size() > kept_placements) placements_.pop_back();
        entry = placements_.front();
    }
    std::call_once(*entry.found, [&] { *entry.placed = place_sector({manual_probes_, no_probes_}, scene, sector, settings); });
    return entry.placed;
}

std::shared_ptr<const SampleTable> World::samples_for(const Settings& settings) {
    const std::uint32_t dimensions = sample_dimensions(settings.bounces, !lights_.empty());
    const std::lock_guard lock(mutex_);
    if (!samples_ || samples_->count() != settings.rays || sample_dimensions_ != dimensions) {
        samples_ = std::make_shared<const SampleTable>(settings.rays, dimensions);
        sample_dimensions_ = dimensions;
    }
    return samples_;
}

}  // namespace drtv::bake
