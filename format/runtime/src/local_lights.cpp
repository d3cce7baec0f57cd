#include <drtv/local_lights.h>

#include "search.h"
#include "share_batches.h"
#include "simd.h"
#include "vector.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace drtv {
namespace {

// Where automatic probes stand over the ground.
constexpr double probe_height_m = 1;
// A lamp is held to be no lower over the ground: there its bounce is bound too.
constexpr double lowest_lamp_m = 0.25;
// Rooms keep light that flat ground does not: by what a lamp may be brighter than its source.
constexpr double largest_factor = 3;

// What a lamp at a height over flat ground brings by one bounce, in band 0, to a probe at probe_height_m over
// it, up to a constant. What the lamp sends to the ground and what the probe gets from there both are Poisson
// kernels, which convolve to the one of both heights' sum; the distance between the two holds the heights'
// difference.
double ground_bounce(double squared_distance_m2, double lamp_m) {
    const double squared = squared_distance_m2 + 4 * lamp_m * probe_height_m;
    return (lamp_m + probe_height_m) / (squared * std::sqrt(squared));
}

LightShare share_of(const PointLight& light, const SectorView& sector, std::uint8_t probe, float share) {
    LightShare part;
    part.sector = {sector.i, sector.j};
    part.probe = probe;
    part.source = exact_position_m(sector, probe);
    part.light = light.position;
    for (std::size_t c = 0; c < channel_count; ++c)
        part.intensity[c] = light.intensity[c] * share;
    return part;
}

// The index of a probe among the local sources of a sector; nothing where it is none.
std::optional<std::size_t> find_source(const SectorView& sector, SectorId of, std::uint8_t probe) {
    const std::int64_t di = std::int64_t{of.i} - sector.i;
    const std::int64_t dj = std::int64_t{of.j} - sector.j;
    const std::span<const LocalSource> sources = sector.local_sources;
    const std::size_t n = index_where(
        sources, [&](const LocalSource& s) { return s.probe == probe && s.di == di && s.dj == dj; });
    return n < sources.size() ? std::optional(n) : std::nullopt;
}

// What a light at one probe brings to another by bounce, all channels and directions; below 0 where the files
// do not say, because the receiver's has no local transfer.
float bounce_between(const ProbeShare& receiver, const ProbeShare& source) {
    const SectorView& sector = receiver.sector->view;
    if (sector.local_receivers.empty())
        return -1;
    const SectorView& of = source.sector->view;
    const auto index = find_source(sector, {of.i, of.j}, source.probe);
    if (!index)
        return 0;
    const auto [codes, scale] = find_local_pair(sector, receiver.probe, *index);
    if (codes == nullptr)
        return 0;
    float sum = 0;
    for (const auto& channel : *codes)
        sum += decode_fixed(channel[0], scale);
    return sum;
}

// How far two probes see the same space, 0 to 1, by what they send each other: a quarter or more of what they
// would over flat ground counts as all of it. 1 where the files do not say. `own`: the product of what each
// brings to itself.
float sees(const ProbeShare& a, const ProbeShare& b, float own) {
    constexpr float enough = 0.25f;
    const float there = bounce_between(a, b);
    const float back = bounce_between(b, a);
    if (!(own > 0) || there < 0 || back < 0)
        return 1;
    const Double3 place_a = exact_position_m(a.sector->view, a.probe);
    const Double3 place_b = exact_position_m(b.sector->view, b.probe);
    const double apart = ground_bounce(squared_distance(place_a, place_b), probe_height_m);
    const auto flat = static_cast<float>(apart / ground_bounce(0, probe_height_m));
    return std::min(1.0f, std::max(there, back) / (std::sqrt(own) * flat * enough));
}

// A cell does not know walls: a lamp beside one would give half of its light to the other side. So a probe's
// share falls with what of the shares it does not see, steeply: the side that has more of them takes nearly
// all.
void keep_to_one_side(std::span<ProbeShare> probes) {
    std::array<float, max_shares_per_light> own{};
    for (std::size_t k = 0; k < probes.size(); ++k)
        own[k] = bounce_between(probes[k], probes[k]);
    std::array<float, max_shares_per_light> seen{};
    float all = 0;
    for (std::size_t k = 0; k < probes.size(); ++k) {
        all += probes[k].share;
        seen[k] += probes[k].share;
        for (std::size_t j = k + 1; j < probes.size(); ++j) {
            const float pair = sees(probes[k], probes[j], own[k] * own[j]);
            seen[k] += pair * probes[j].share;
            seen[j] += pair * probes[k].share;
        }
    }
    for (std::size_t k = 0; k < probes.size(); ++k) {
        const float share = seen[k] / all;
        const float squared = share * share;
        const float to_fourth = squared * squared;
        probes[k].share *= to_fourth * to_fourth;
    }
}

// How much more a lamp itself brings than its share at the source, if all stood over flat ground.
float ground_bounce_ratio(const Double3& receiver, const LightShare& share) {
    const double lamp_m = std::max(lowest_lamp_m, probe_height_m + share.light[2] - share.source[2]);
    const double from_lamp = ground_bounce(squared_distance(share.light, receiver), lamp_m);
    const double from_source = ground_bounce(squared_distance(share.source, receiver), probe_height_m);
    return static_cast<float>(std::min(largest_factor, from_lamp / from_source));
}

bool shines(const PointLight& light) {
    const Float3& c = light.intensity;
    const bool placed = std::isfinite(light.position[0]) && std::isfinite(light.position[1]) &&
                        std::isfinite(light.position[2]);
    return placed && is_finite(c) && (c[0] != 0 || c[1] != 0 || c[2] != 0);
}

}  // namespace

std::size_t split_light(const SectorSet& set, const PointLight& light, std::span<LightShare> shares) {
    if (!shines(light))
        return 0;
    if (const InteriorShare room = set.interior(light.position, 0); room.sector != nullptr) {
        const SectorView& sector = room.sector->view;
        shares[0] = share_of(light, sector, sector.interiors[room.index].probe, 1);
        return 1;
    }
    ProbeBlend blend = set.outdoors(set.trilinear(light.position));
    const std::size_t count = blend.count;
    keep_to_one_side({blend.probes.data(), count});
    float sum = 0;
    for (std::size_t n = 0; n < count; ++n)
        sum += blend.probes[n].share;
    for (std::size_t n = 0; n < count; ++n) {
        const ProbeShare& probe = blend.probes[n];
        shares[n] = share_of(light, probe.sector->view, probe.probe, probe.share / sum);
    }
    return count;
}

LocalRelighter::LocalRelighter(const LoadedSector& sector, std::span<const LightShare> shares)
    : sector_(&sector.view) {
    for (const LightShare& share : shares) {
        if (!is_beside(*sector_, share.sector))
            continue;
        if (const auto source = find_source(*sector_, share.sector, share.probe))
            sources_[count_++] = {static_cast<std::uint16_t>(*source), &share};
    }
}

void LocalRelighter::add_to(BasisColours& colours, std::size_t p) const {
    const Double3 receiver = exact_position_m(*sector_, p);
    std::array<Lanes, channel_count> sums = {splat(0), splat(0), splat(0)};
    bool any = false;
    for (std::size_t n = 0; n < count_; ++n) {
        const auto [codes, scale] = find_local_pair(*sector_, p, sources_[n].index);
        if (codes == nullptr)
            continue;
        any = true;
        const LightShare& share = *sources_[n].share;
        const float factor = ground_bounce_ratio(receiver, share);
        const float per_code = scale / fixed_point_max * factor;
        for (std::size_t c = 0; c < channel_count; ++c)
            sums[c] = sums[c] + load_codes((*codes)[c].data()) * splat(per_code * share.intensity[c]);
    }
    if (!any)
        return;
    for (std::size_t c = 0; c < channel_count; ++c) {
        Float4 local;
        store(sums[c], local.data());
        for (std::size_t b = 0; b < basis_count; ++b) {
            const Float4 y = evaluate_sh(transfer_basis[b]);
            colours[b][c] += (local[0] * y[0] + local[2] * y[2]) + (local[1] * y[1] + local[3] * y[3]);
        }
    }
}

}  // namespace drtv
