// What commands that relight a set of sectors share: lamps, and a volume over all sectors, relit once.
#pragma once

#include "light_request.h"

#include <drtv/volume.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace drtv::kit {

// Of all lamps.
[[nodiscard]] std::vector<LightShare> split_lamps(const SectorSet& set, std::span<const PointLight> lamps);

// Light that no loaded sector takes is hardly meant; others may, so it is no error. `where` the sectors are:
// "around the places".
void warn_of_lost_light(const SectorSet& set, const RequestedLight& requested, const std::string& where);

// rgba8, rgba8-sqrt or rgba16f.
[[nodiscard]] TexelEncoding encoding_of(const std::string& name);

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
