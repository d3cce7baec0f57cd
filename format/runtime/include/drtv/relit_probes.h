// The colours of all probes of a set under one light, or during a fade from one light to the next. Volumes
// are filled from them. 24 bytes per probe, twice that with fades.
//
// Memory: one block of the caller's. Threads: different sectors may be relit on different threads at once; a
// volume is filled from them after that. `set_light`, `set_fade` and `finish_fade` run alone.
//
// Without fades:
//
//     relit.set_light(Shown::now, light);
//     for (const LoadedSector* sector : loaded) relit.relight(Shown::now, *sector, light, lamps);
//
// Over frames: set_light(Shown::next, ...) and relight all sectors as Shown::next, some per frame; then
// set_fade from 0 to 1 over some frames; then finish_fade. What is shown is (1 - s) now + s next, with the
// same s for all sectors. Relight a sector that arrives meanwhile for both.
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

    // Sets the light of places without a probe. REQUIRES, here and below: `next` only with fades.
    void set_light(Shown shown, const SceneLight& light);
    // Relights all probes of one sector. Cost: some 10 ns per probe, and as much for each pair of lamp and
    // probe.
    void relight(Shown shown,
                 const LoadedSector& sector,
                 const SceneLight& light,
                 std::span<const LightShare> lamps);

    // From 0 (now) to 1 (next); above 0 only once all sectors are relit for both.
    void set_fade(float share);
    [[nodiscard]] float fade() const { return fade_; }
    // Makes `next` the new `now`, and the fade 0.
    void finish_fade();

    // Whether the sector has been relit since it was loaded; until then it shows the fallback.
    [[nodiscard]] bool is_relit(const LoadedSector& sector) const;
    // A number that changes whenever what the sector's probes show changes, or what the fallback shows.
    [[nodiscard]] std::uint64_t stamp(const LoadedSector& sector) const;
    [[nodiscard]] std::uint64_t fallback_stamp() const;

    // What is shown. REQUIRES: is_relit(sector), p < sector.view.probe_count.
    [[nodiscard]] BasisColours colours(const LoadedSector& sector, std::size_t p) const;
    // The colours of an open sky, to be multiplied by a place's sky_factor.
    [[nodiscard]] BasisColours fallback() const;
    // The largest colour that the sector's probes show, or the fallback, for suggest_scale.
    [[nodiscard]] float largest(const LoadedSector& sector) const;
    [[nodiscard]] float largest_fallback() const;

  private:
    struct Light {
        std::span<PackedColours> colours;
        BasisColours fallback{};
        std::uint64_t stamp = 0;
    };
    // What was relit last in a slot, for now and next.
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
