// A volume over all sectors of a set, relit once, for `drtv relight --by volume`.
#pragma once

#include <drtv/volume.h>

#include <cstddef>
#include <span>
#include <vector>

namespace drtv::kit {

class RelitVolume {
  public:
    // `set` must outlive this. The scale is what suggest_scale gives of all sectors and the open sky.
    RelitVolume(const SectorSet& set,
                const SceneLight& light,
                std::span<const LightShare> lamps,
                const VolumeSettings& settings);

    // With the window around the camera, until the next call.
    [[nodiscard]] const Volume& at(const Double3& camera);

    // All sectors' probes.
    [[nodiscard]] const RelitProbes& relit() const { return relit_; }

  private:
    const SectorSet& set_;
    std::vector<std::byte> relit_memory_;
    RelitProbes relit_;
    std::vector<std::byte> volume_memory_;
    Volume volume_;
};

}  // namespace drtv::kit
