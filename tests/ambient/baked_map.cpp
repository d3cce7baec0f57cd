#include "tests/ambient/baked_map.h"

#include "bakerd/bake/sector_bake.h"
#include "bakerd/trace/device.h"
#include "tests/bake/worlds.h"

#include <stdexcept>

namespace drtv::test {

BakedMap::BakedMap(const GltfBuilder& builder, const settings::BakeSettings& settings,
                   const std::vector<map::SectorCoordinate>& sectors) {
    world_ = open_world(builder);
    const trace::FloatMode float_mode;
    for (const map::SectorCoordinate sector : sectors.empty() ? world_->sectors() : sectors) {
        const auto baked = bake::bake_sector(*world_, sector, settings);
        if (!baked)
            throw std::runtime_error(baked.error());
        files_.push_back(baked->sector);
        sectors_.push_back(&set_.add(baked->sector));
    }
}

}  // namespace drtv::test
