// One moment's light: the sectors relit by it, as a shader finds them, and the light that comes straight.
#pragma once

#include "bakerd/picture/incidence.h"
#include "bakerd/picture/vectors.h"
#include "format/kit/light_request.h"
#include "format/kit/relit_volume.h"

#include <drtv/ambient.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace drtv::picture {

// Where a surface asks: surface_offset_m along its normal.
[[nodiscard]] inline glm::vec3 asked_place(const glm::vec3& at, const glm::vec3& normal) {
    return at + normal * surface_offset_m;
}

enum class By : std::uint8_t { nearest, trilinear, volume };

struct RelightChoice {
    By by = By::volume;
    TexelEncoding encoding = TexelEncoding::rgba16f;
    bool interiors = true;
};

[[nodiscard]] VolumeSettings volume_settings(const RelightChoice& choice);

// A share of colours to others.
void add(BasisColours& sum, const BasisColours& colours, float share);

class Moment {
  public:
    // Relights all sectors of the set. `window`: the middle of the volume. `light` and `set` must outlive
    // this.
    Moment(const SectorSet& set,
           const kit::RequestedLight& light,
           const RelightChoice& choice,
           const Double3& window);

    // Thread-safe, as all below.
    [[nodiscard]] Ambient ambient(const glm::vec3& at, const glm::vec3& normal) const;
    // Its colour alone, from probes that are relit already: many times faster, and the same but for the
    // rounding of binary16.
    [[nodiscard]] glm::vec3 ambient_colour(const glm::vec3& at, const glm::vec3& normal) const;

    [[nodiscard]] const SectorSet& set() const { return set_; }
    [[nodiscard]] const SceneLight& light() const { return light_.light; }
    [[nodiscard]] std::span<const PointLight> lamps() const { return light_.lamps; }
    [[nodiscard]] const RelightChoice& choice() const { return choice_; }
    // Null unless the choice is By::volume.
    [[nodiscard]] const Volume* volume() const { return volume_; }

    // Nothing where it is not above the horizon.
    [[nodiscard]] std::optional<Incidence> sun() const;
    // What the map's own lights of a group (empty: of none) are multiplied with.
    [[nodiscard]] glm::vec3 factor_of(std::string_view group) const;

    // What a unit direction shows where nothing stands: the sky, with the sun in it; below the horizon, what
    // the horizon shows. `with_sun`: its disc, half a degree wide.
    [[nodiscard]] glm::vec3 sky(const glm::vec3& direction, bool with_sun) const;

  private:
    void add_blend(BasisColours& sum, const ProbeBlend& blend, const Double3& asked, float share) const;

    const SectorSet& set_;
    const kit::RequestedLight& light_;
    const RelightChoice choice_;
    std::vector<LightShare> shares_;
    kit::RelitVolume relit_;
    const Volume* volume_;
    const BasisColours open_sky_;
};

}  // namespace drtv::picture
