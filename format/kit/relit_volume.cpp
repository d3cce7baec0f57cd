#include "relit_volume.h"

#include "sector_folder.h"

#include <algorithm>

namespace drtv::kit {

RelitVolume::RelitVolume(const SectorSet& set,
                         const SceneLight& light,
                         std::span<const LightShare> lamps,
                         const VolumeSettings& settings)
    : set_(set),
      relit_memory_(RelitProbes::memory_bytes(set.limits(), false)),
      relit_(relit_memory_, set.limits(), false),
      volume_memory_(Volume::memory_bytes(settings, set.limits())),
      volume_(volume_memory_, settings, set.limits()) {
    relit_.set_light(Shown::now, light);
    float largest = relit_.largest_fallback();
    for_each_sector(set, [&](const LoadedSector& sector) {
        relit_.relight(Shown::now, sector, light, lamps);
        largest = std::max(largest, relit_.largest(sector));
    });
    volume_.set_scale(suggest_scale(largest, 0));
}

const Volume& RelitVolume::at(const Double3& camera) {
    volume_.update(set_, relit_, camera);
    return volume_;
}

}  // namespace drtv::kit
