// The colours of all probes of a set under one light, or on the way from one light to the next: what volumes
// are filled from. 24 bytes per probe, twice that where a fade is asked for.
//
// Memory: the caller's, one piece. Threads: sectors may be relit on any number of threads at once, each by
// one; a volume is filled from them when that is done. `set_light`, `set_fade` and `finish_fade` run alone.
//
// Without fades:
//
//     relit.set_light(Shown::now, light);
//     for (const LoadedSector* sector : loaded) relit.relight(Shown::now, *sector, light, lamps);
//
// Over frames: set_light(Shown::next, ...) and relight all sectors as Shown::next, some per frame; then
// set_fade from 0 to 1 over some frames; then finish_fade. What is shown is (1 - s) now + s next, with one s
// for all. A sector that arrives meanwhile is relit for both.
#pragma once

#include <drtv/local_lights.h>
#include <drtv/relight.h>
#include <drtv/sector_set.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drtv {

enum class Shown : std::uint8_t { now, next };

class RelitProbes {
  public:
    [[nodiscard]] static std::size_t memory_bytes(const SectorSetLimits& limits, bool with_fade);

    // REQUIRES: as for SectorSet; `limits` are the set's.
    RelitProbes(std::span<std::byte> memory, const SectorSetLimits& limits, bool with_fade);
    RelitProbes(const RelitProbes&) = delete;
    RelitProbes& operator=(const RelitProbes&) = delete;

    // The light of places without a probe. REQUIRES, here and below: `next` only with fades.
    void set_light(Shown shown, const SceneLight& light);
    // All probes of one sector. Cost: some 10 ns per probe, and per pair of lamp and probe as much.
    void relight(Shown shown,
                 const LoadedSector& sector,
                 const SceneLight& light,
                 std::span<const LightShare> lamps);

    // From 0 (now) to 1 (next); above 0 only once all sectors are relit for both.
    void set_fade(float share);
    [[nodiscard]] float fade() const { return fade_; }
    // What was next is now, and the fade is 0.
    void finish_fade();

    // Whether the sector has been relit since it was loaded: before, it shows the fallback.
    [[nodiscard]] bool is_relit(const LoadedSector& sector) const;
    // Changes with whatever changes what the sector's probes show, or (without a sector) the fallback.
    [[nodiscard]] std::uint64_t stamp(const LoadedSector& sector) const;
    [[nodiscard]] std::uint64_t fallback_stamp() const;

    // What is shown. REQUIRES: is_relit(sector), p < sector.view.probe_count.
    [[nodiscard]] BasisColours colours(const LoadedSector& sector, std::size_t p) const;
    // An open sky's; times a place's sky_factor.
    [[nodiscard]] BasisColours fallback() const;
    // Of the sector's probes, or of the fallback: the largest that is shown, for suggest_scale.
    [[nodiscard]] float largest(const LoadedSector& sector) const;
    [[nodiscard]] float largest_fallback() const;

  private:
    struct Light {
        std::span<PackedColours> colours;
        BasisColours fallback{};
        std::uint64_t stamp = 0;
    };
    // Of the sector that was relit last, for now and next.
    struct Relit {
        std::uint64_t load = 0;
        std::uint64_t stamp = 0;
        float largest = 0;
    };
    using Slot = std::array<Relit, 2>;

    std::array<Light, 2> lights_;  // now, next
    std::span<Slot> slots_;
    float fade_ = 0;
    std::uint64_t fade_stamp_ = 0;
    std::atomic<std::uint64_t> clock_{0};  // each change takes the next number
};

}  // namespace drtv
