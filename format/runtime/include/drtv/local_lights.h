// The bounce of lamps that move (slides 23, 30 and 31 of the talk, see drtv/light.h): a lamp is split among
// the probes around it, and the files say what each of these sends to others by bounce (local transfer). The
// lamp's direct light is left to the game.
//
// Pure functions, thread-safe, no allocation.
//
//     std::array<drtv::LightShare, drtv::max_shares_per_light> shares;
//     std::size_t count = drtv::split_light(set, {.position = at, .intensity = {50, 40, 30}}, shares);
//     drtv::LocalRelighter local(*sector, {shares.data(), count});
//     local.add_to(colours, probe);
#pragma once

#include <drtv/relight.h>
#include <drtv/sector_set.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drtv {

// A lamp that shines equally in all directions. A spot light counts by its flux: intensity = flux / (4 pi).
struct PointLight {
    Double3 position{};
    Float3 intensity{};  // W/sr, by channel
};

// A part of a lamp. Its bounce is that of a light at the place of a probe.
struct LightShare {
    SectorId sector;  // of the probe
    std::uint8_t probe = 0;
    Double3 source{};    // the probe's place
    Double3 light{};     // the lamp's
    Float3 intensity{};  // W/sr: the lamp's times the share
};

inline constexpr std::size_t max_shares_per_light = 8;

// Splits a lamp among the probes of the eight grid cells around it, each cell's outdoor probe, with the
// shares w of SectorSet::outdoors(trilinear(...)), which change continuously while the lamp moves. Cells know
// nothing of walls, so the share of probe k is multiplied by (sum over j of w_j sees_kj)^8, over all probes j
// of the eight cells; sees_kk is 1. With R_kj what the files' local transfer brings from one to the other
// (band 0, all channels added) and d their distance,
//
//     sees_kj = min(1, max(R_kj, R_jk) / (sqrt(R_kk R_jj) (1 + d^2 / 4 m^2)^(-3/2) / 4))
//
// where (...)^(-3/2) is the part that is left at d over flat ground. sees_kj is 1 where the files do not say:
// where there is no local transfer, or a probe brings nothing to itself. A lamp inside an interior (with a
// softness of 0) goes to the interior's probe alone. A lamp outside goes to no interior's probe, unless a
// sector has no other probes. The shares of the probes that are there add up to 1. Returns how many shares it
// wrote: none where no probe is there, or where the lamp is dark or not finite. REQUIRES: room for
// max_shares_per_light.
[[nodiscard]] std::size_t split_light(const SectorSet& set,
                                      const PointLight& light,
                                      std::span<LightShare> shares);

// Shares prepared for the probes of one sector.
class LocalRelighter {
  public:
    static constexpr std::size_t max_shares = 512;

    // Shares at probes more than one sector away bring nothing. `sector` and `shares` must outlive this.
    // REQUIRES: at most max_shares; for more, use several objects.
    LocalRelighter(const LoadedSector& sector, std::span<const LightShare> shares);

    // Adds what probe p gets from the shares. A lamp does not stand where its source does, so each pair takes
    // the factor min(3, B(|lamp - p|, h) / B(|source - p|, 1 m)). B(d, h) = (h + 1 m) (d^2 + 4 h 1 m)^(-3/2)
    // is what flat ground sends back (band 0, one bounce) from a lamp h above it to a probe 1 m above it, and
    // h = max(1/4 m, 1 m + lamp.z - source.z). REQUIRES: p < view.probe_count.
    void add_to(BasisColours& colours, std::size_t p) const;
    // True where nothing is added to any probe.
    [[nodiscard]] bool empty() const { return count_ == 0; }

  private:
    struct Source {
        std::uint16_t index;
        const LightShare* share;
    };

    const SectorView* sector_;
    std::array<Source, max_shares> sources_;
    std::size_t count_ = 0;
};

}  // namespace drtv
