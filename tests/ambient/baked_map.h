// A map baked in this process and loaded as a game loads it.
#pragma once

#include "bakerd/bake/world.h"
#include "bakerd/map/ground.h"
#include "bakerd/map/map.h"
#include "settings/bake_settings.h"
#include "tests/map/gltf_builder.h"
#include "tests/runtime/sets.h"

#include <memory>
#include <vector>

namespace drtv::test {

class BakedMap {
  public:
    // All of the map's sectors, or those asked for.
    BakedMap(const GltfBuilder& builder, const settings::BakeSettings& settings,
             const std::vector<map::SectorCoordinate>& sectors = {});

    [[nodiscard]] const map::Map& map() const { return world_->map(); }
    [[nodiscard]] const SectorSet& set() const { return *set_; }
    [[nodiscard]] const std::vector<const LoadedSector*>& sectors() const { return sectors_; }
    [[nodiscard]] const std::vector<Sector>& files() const { return files_; }

  private:
    std::shared_ptr<bake::World> world_;
    std::vector<Sector> files_;
    OwnedSet set_;
    std::vector<const LoadedSector*> sectors_;
};

}  // namespace drtv::test
