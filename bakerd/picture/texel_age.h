// When the texels of a volume were last written, for a camera that has walked to where it stands.
#pragma once

#include "bakerd/picture/moment.h"

#include <drtv/volume.h>

#include <array>
#include <cstdint>
#include <vector>

namespace drtv::picture {

class TexelAge {
  public:
    // It walks straight ahead, so far a frame: over half of the volume in all.
    static constexpr int frames = 64;
    static constexpr float step_m = 3;

    TexelAge(const SectorSet& set,
             const kit::RequestedLight& light,
             const RelightChoice& choice,
             const glm::vec3& eye,
             const glm::vec3& forward);

    // Frames since the texel of a place was written, at most `frames`; outside of the volume as many.
    [[nodiscard]] int frames_at(const glm::vec3& place) const;

  private:
    void note(const Volume& volume, int frame);

    VolumeSettings settings_;
    std::array<std::int32_t, 3> window_{};  // where the walk ends: its lowest texel of the world
    std::vector<std::int32_t> written_;     // the frame, by place in the texture
};

}  // namespace drtv::picture
