#include "tests/ambient/baked_map.h"

#include "bakerd/bake/sector_bake.h"
#include "bakerd/trace/device.h"

#include <stdexcept>

namespace drtv::test {

BakedMap::BakedMap(const GltfBuilder& builder, const bake::Settings& settings,
                   const std::vector<map::SectorCoordinate>& sectors) {
    auto imported = builder.import();
    if (!imported)
        throw std::runtime_error(imported.error());
    map_ = std::make_shared<const map::Map>(std::move(*imported));
    const trace::FloatMode float_mode;
    const auto world = bake::World::open(trace::Device::open().value(), map_);
    if (!world)
        throw std::runtime_error(world.error());
    for (const map::SectorCoordinate sector : sectors.empty() ? (*world)->sectors() : sectors) {
        const auto baked = bake::bake_sector(**world, sector, settings);
        if (!baked)
            throw std::runtime_error(baked.error());
        files_.push_back(baked->sector);
        sectors_.push_back(&set_.add(baked->sector));
    }
}

}  // namespace drtv::test
