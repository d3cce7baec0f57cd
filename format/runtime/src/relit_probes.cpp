#include <drtv/relit_probes.h>

#include "arena.h"
#include "search.h"
#include "share_batches.h"

#include <algorithm>
#include <array>

namespace drtv {
namespace {

std::size_t index_of(Shown shown) {
    return shown == Shown::now ? 0 : 1;
}

BasisColours mixed(const BasisColours& now, const BasisColours& next, float share) {
    BasisColours colours;
    for (std::size_t b = 0; b < basis_count; ++b) {
        for (std::size_t c = 0; c < channel_count; ++c)
            colours[b][c] = (1 - share) * now[b][c] + share * next[b][c];
    }
    return colours;
}

// Whether a share is near enough to bring something.
bool has_source(const SectorView& sector, std::span<const LightShare> shares) {
    const auto is_near = [&](const LightShare& share) { return is_beside(sector, share.sector); };
    return index_where(shares, is_near) < shares.size();
}

float largest_of(const BasisColours& colours) {
    float largest = 0;
    for (const Float3& colour : colours)
        largest = std::max({largest, colour[0], colour[1], colour[2]});
    return largest;
}

}  // namespace

std::size_t RelitProbes::memory_bytes(const SectorSetLimits& limits, bool with_fade) {
    const std::size_t lights = with_fade ? 2 : 1;
    return lights * Arena::bytes_of<PackedColours>(limits.probes) + Arena::bytes_of<Slot>(limits.sectors);
}

RelitProbes::RelitProbes(std::span<std::byte> memory, const SectorSetLimits& limits, bool with_fade) {
    Arena arena(memory);
    lights_[0].colours = arena.take<PackedColours>(limits.probes);
    if (with_fade)
        lights_[1].colours = arena.take<PackedColours>(limits.probes);
    slots_ = arena.take<Slot>(limits.sectors);
}

void RelitProbes::set_light(Shown shown, const SceneLight& light) {
    Light& to = lights_[index_of(shown)];
    to.fallback = clamped(open_sky(light));
    to.stamp = ++clock_;
}

void RelitProbes::relight(Shown shown,
                          const LoadedSector& sector,
                          const SceneLight& light,
                          std::span<const LightShare> lamps) {
    const std::size_t index = index_of(shown);
    const ProbeRelighter relighter(sector.view, light);
    const std::span<PackedColours> out =
        lights_[index].colours.subspan(sector.first_probe, sector.view.probe_count);
    float largest = 0;
    if (!has_source(sector.view, lamps)) {
        largest = relighter.pack_all(out);
    } else {
        std::array<BasisColours, max_probes> colours;
        for (std::size_t p = 0; p < out.size(); ++p)
            colours[p] = relighter(p);
        for_each_batch(sector, lamps, [&](const LocalRelighter& local) {
            for (std::size_t p = 0; p < out.size(); ++p)
                local.add_to(colours[p], p);
        });
        for (std::size_t p = 0; p < out.size(); ++p) {
            const BasisColours visible = clamped(colours[p]);
            largest = std::max(largest, largest_of(visible));
            out[p] = packed(visible);
        }
    }
    slots_[sector.slot][index] = {sector.load, ++clock_, largest};
}

void RelitProbes::set_fade(float share) {
    const float within = share > 0 ? std::min(share, 1.0f) : 0.0f;
    if (within != fade_)
        fade_stamp_ = ++clock_;
    fade_ = within;
}

void RelitProbes::finish_fade() {
    std::swap(lights_[0], lights_[1]);
    for (Slot& slot : slots_)
        std::swap(slot[0], slot[1]);
    fade_ = 0;
    fade_stamp_ = ++clock_;
}

bool RelitProbes::is_relit(const LoadedSector& sector) const {
    const auto& [now, next] = slots_[sector.slot];
    return now.load == sector.load && (fade_ == 0 || next.load == sector.load);
}

std::uint64_t RelitProbes::stamp(const LoadedSector& sector) const {
    const auto& [now, next] = slots_[sector.slot];
    return std::max({now.stamp, fade_ == 0 ? 0 : next.stamp, fade_stamp_});
}

std::uint64_t RelitProbes::fallback_stamp() const {
    return std::max({lights_[0].stamp, fade_ == 0 ? 0 : lights_[1].stamp, fade_stamp_});
}

BasisColours RelitProbes::colours(const LoadedSector& sector, std::size_t p) const {
    const std::size_t at = sector.first_probe + p;
    const BasisColours now = unpacked(lights_[0].colours[at]);
    return fade_ == 0 ? now : mixed(now, unpacked(lights_[1].colours[at]), fade_);
}

BasisColours RelitProbes::fallback() const {
    return fade_ == 0 ? lights_[0].fallback : mixed(lights_[0].fallback, lights_[1].fallback, fade_);
}

float RelitProbes::largest(const LoadedSector& sector) const {
    const auto& [now, next] = slots_[sector.slot];
    return fade_ == 0 ? now.largest : std::max(now.largest, next.largest);
}

float RelitProbes::largest_fallback() const {
    const float now = largest_of(lights_[0].fallback);
    return fade_ == 0 ? now : std::max(now, largest_of(lights_[1].fallback));
}

}  // namespace drtv
