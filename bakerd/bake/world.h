// A map made ready for baking: geometry, volumes, and the scenes around the sectors at work. Thread-safe.
#pragma once

#include "bakerd/bake/interiors.h"
#include "bakerd/bake/lights.h"
#include "bakerd/bake/placed_sector.h"
#include "bakerd/bake/recent.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/map/ground.h"
#include "bakerd/map/map.h"
#include "bakerd/trace/scene.h"
#include "placement/closed_volume.h"
#include "settings/bake_settings.h"

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::bake {

using Placed = tl::expected<PlacedSector, std::string>;

// What a sector is baked in.
struct Surroundings {
    std::shared_ptr<const trace::Scene> scene;   // holds all within scene_distance_m of the sector
    std::shared_ptr<const SampleTable> samples;  // of the paths of its probes
};

class World {
  public:
    // With a shelf, the geometry of meshes that a map before had is used again. Fails with a sentence when
    // the map is too large, a volume is not closed, or bake_spacing has too many values.
    [[nodiscard]] static tl::expected<std::shared_ptr<World>, std::string> open(
        std::shared_ptr<const trace::Device> device,
        std::shared_ptr<const map::Map> map,
        std::shared_ptr<trace::MeshShelf> shelf = nullptr);

    [[nodiscard]] const map::Map& map() const { return *geometry_.map(); }
    [[nodiscard]] const StaticLights& lights() const { return lights_; }
    [[nodiscard]] float max_scattered() const {
        return max_scattered_;
    }  // trace::max_scattered, where there are lights
    [[nodiscard]] const std::vector<InteriorVolume>& interiors() const { return interiors_; }
    // Of interiors that no file will hold; one sentence each.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    [[nodiscard]] const PlacementTags& placement_tags() const { return tags_; }
    [[nodiscard]] const std::vector<map::SectorCoordinate>& sectors() const { return sectors_; }
    [[nodiscard]] bool has_sector(map::SectorCoordinate sector) const;

    // Whether a part of the mesh is closed (trace::ClosedParts).
    [[nodiscard]] bool bounds_volume(std::uint32_t mesh) { return !geometry_.closed_parts_of(mesh)->empty(); }

    // All objects within a distance of the sector, and some more: the scene is shared by the 8 x 8 sectors of
    // its tile, so that neighbours do not build it again. What it holds beyond the distance changes no answer
    // within.
    [[nodiscard]] std::shared_ptr<const trace::Scene> scene_for(map::SectorCoordinate sector,
                                                                float distance_m);

    [[nodiscard]] Surroundings surroundings(map::SectorCoordinate sector,
                                            const settings::BakeSettings& settings);

    // The probes of a sector, found once for itself and for all its neighbours. REQUIRES: the scene holds all
    // within scene_distance_m of a sector or of its neighbour.
    [[nodiscard]] std::shared_ptr<const Placed> placed(map::SectorCoordinate sector,
                                                       const settings::BakeSettings& settings,
                                                       const trace::Scene& scene);

    [[nodiscard]] std::shared_ptr<const SampleTable> samples(std::uint32_t count, std::uint32_t dimensions);

  private:
    struct SceneKey {
        map::SectorCoordinate tile;
        float distance_m;
        bool operator==(const SceneKey&) const = default;
    };
    struct PlacementKey {
        map::SectorCoordinate sector;
        float reach_m;
        float min_distance_m;
        bool operator==(const PlacementKey&) const = default;
    };
    struct SampleKey {
        std::uint32_t count;
        std::uint32_t dimensions;
        bool operator==(const SampleKey&) const = default;
    };
    [[nodiscard]] tl::expected<void, std::string> open_volumes();
    [[nodiscard]] tl::expected<void, std::string> check_spacings() const;
    void tag_probes();  // with the interiors that name them

    World(std::shared_ptr<const trace::Device> device,
          const std::shared_ptr<const map::Map>& map,
          std::shared_ptr<trace::MeshShelf> shelf);

    trace::MapGeometry geometry_;
    const StaticLights lights_;
    const float max_scattered_;
    std::vector<map::SectorCoordinate> sectors_;  // sorted by (j, i)
    std::vector<InteriorVolume> interiors_;
    PlacementTags tags_;  // refers to the interiors
    std::vector<std::string> warnings_;

    Recent<SceneKey, std::shared_ptr<const trace::Scene>> scenes_;
    Recent<PlacementKey, Placed> placements_;
    Recent<SampleKey, SampleTable> samples_;
};

}  // namespace drtv::bake
