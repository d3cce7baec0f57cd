#include "bakerd/bake/local_encoding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace drtv::bake {
namespace {

constexpr int min_exponent = -60;  // of a source or of a receiver; no light is that faint

// Of a pair's largest code. A pair is known to 1 % at best, and this rounds it to 0.2 % of its largest: what
// it drops is noise, which would be most of a compressed file. Measured by build/ci/tests/format_bench
// (docs/measurements.md, "Filters before zstd").
constexpr int significant_bits = 8;

std::int64_t square_distance(const placement::Position& a, const placement::Position& b) {
    const std::int64_t x = a.x - b.x;
    const std::int64_t y = a.y - b.y;
    const std::int64_t z = a.z - b.z;
    return x * x + y * y + z * z;
}

std::int64_t square_units(float distance_m) {
    const auto units = static_cast<std::int64_t>(distance_m * position_units_per_m);
    return units * units;
}

float largest(const LocalCoefficients& coefficients) {
    float most = 0;
    for (const auto& channel : coefficients) {
        for (const float value : channel)
            most = std::max(most, std::abs(value));
    }
    return most;
}

// A probe that may be a source.
struct Candidate {
    std::int32_t dj;
    std::int32_t di;
    std::uint32_t probe;
    placement::Position position;
};

// All of the sector, then those of its neighbours by j, i and index.
std::vector<Candidate> candidates_around(const PlacedSector& placed,
                                         std::span<const PlacedSector* const> neighbours) {
    std::vector<Candidate> candidates;
    const auto add_all = [&](const PlacedSector& sector) {
        const std::int32_t dj = sector.sector.j - placed.sector.j;
        const std::int32_t di = sector.sector.i - placed.sector.i;
        for (std::uint32_t p = 0; p < sector.positions.size(); ++p)
            candidates.push_back({dj, di, p, sector.positions[p]});
    };
    add_all(placed);
    for (const PlacedSector* neighbour : neighbours)
        add_all(*neighbour);
    const auto first_of_neighbours =
        candidates.begin() + static_cast<std::ptrdiff_t>(placed.positions.size());
    std::sort(first_of_neighbours, candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.dj, a.di, a.probe) < std::tie(b.dj, b.di, b.probe);
    });
    return candidates;
}

// The candidates that are nearest to a receiver, ascending.
std::vector<std::uint32_t> nearest(const placement::Position& receiver,
                                   std::span<const Candidate> candidates,
                                   float reach_m) {
    const auto order = [&](std::uint32_t n) {
        const Candidate& c = candidates[n];
        return std::tuple(square_distance(receiver, c.position), c.dj, c.di, c.probe);
    };
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t n = 0; n < candidates.size(); ++n) {
        if (square_distance(receiver, candidates[n].position) <= square_units(reach_m))
            chosen.push_back(n);
    }
    if (chosen.size() > max_local_sources) {
        const auto end = chosen.begin() + max_local_sources;
        std::ranges::nth_element(chosen, end, {}, order);
        chosen.erase(end, chosen.end());
    }
    std::ranges::sort(chosen);
    return chosen;
}

// Rounds all of a pair's codes to one step. Light that is nowhere negative stays so: what rounding, also that
// to codes, lifts over the bound of band 1 is rounded towards zero.
void round_codes(LightCodes& codes) {
    constexpr std::int64_t band1_over_band0 = 11547, one = 10000;  // (2/3) sqrt(3), rounded down
    int most = 0;
    for (const auto& channel : codes) {
        for (const std::int16_t q : channel)
            most = std::max(most, std::abs(int{q}));
    }
    const int shift =
        std::max(static_cast<int>(std::bit_width(static_cast<unsigned>(most))) - significant_bits, 0);
    const int step = 1 << shift;
    const int largest = INT16_MAX / step * step;
    for (auto& channel : codes) {
        for (std::size_t i = 0; i < sh_count; ++i) {
            const int magnitude = std::abs(int{channel[i]});
            int rounded = std::min((magnitude + step / 2) / step * step, largest);
            if (i > 0 && one * rounded > band1_over_band0 * channel[0] && rounded > 0)
                rounded = static_cast<int>(band1_over_band0 * channel[0] / one) / step * step;
            channel[i] = static_cast<std::int16_t>(channel[i] < 0 ? -rounded : rounded);
        }
    }
}

}  // namespace

int exponent_of(float value, int least) {
    if (!(value > 0))
        return least;
    int exponent = 0;
    const float mantissa = std::frexp(value, &exponent);  // in [0.5, 1)
    return std::max(mantissa == 0.5f ? exponent - 1 : exponent, least);
}

LocalSources local_sources(const PlacedSector& placed,
                           std::span<const PlacedSector* const> neighbours,
                           float reach_m) {
    const std::vector<Candidate> candidates = candidates_around(placed, neighbours);
    LocalSources sources;
    std::vector<bool> used(candidates.size());
    for (const placement::Position& receiver : placed.positions) {
        sources.of_receivers.push_back(nearest(receiver, candidates, reach_m));
        for (const std::uint32_t n : sources.of_receivers.back())
            used[n] = true;
    }
    std::vector<std::uint32_t> index_of(candidates.size());
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        if (!used[n])
            continue;
        const Candidate& c = candidates[n];
        index_of[n] = static_cast<std::uint32_t>(sources.sources.size());
        sources.sources.push_back({static_cast<std::int8_t>(c.di),
                                   static_cast<std::int8_t>(c.dj),
                                   static_cast<std::uint8_t>(c.probe),
                                   0});
        sources.positions.push_back(c.position);
    }
    for (std::vector<std::uint32_t>& of_receiver : sources.of_receivers) {
        for (std::uint32_t& source : of_receiver)
            source = index_of[source];
    }
    return sources;
}

// A scale of a source and a receiver together: a source's is what its brightest receiver needs, a receiver's
// what its own strongest pair then still leaves unused. Each pair keeps at least the digits that either alone
// would give it.
LocalTransfer encode_local(const LocalSources& sources, const LocalLight& light) {
    const std::size_t receiver_count = sources.of_receivers.size();
    LocalTransfer transfer;
    transfer.sources = sources.sources;
    std::vector<float> brightest(sources.sources.size(), 0);
    for (std::size_t p = 0; p < receiver_count; ++p) {
        const std::vector<std::uint32_t>& of_receiver = sources.of_receivers[p];
        for (std::size_t n = 0; n < of_receiver.size(); ++n)
            brightest[of_receiver[n]] = std::max(brightest[of_receiver[n]], largest(light.pairs[p][n]));
    }
    for (std::size_t s = 0; s < brightest.size(); ++s)
        transfer.sources[s].exponent = static_cast<std::int8_t>(exponent_of(brightest[s], min_exponent));
    for (std::size_t p = 0; p < receiver_count; ++p) {
        const std::vector<std::uint32_t>& of_receiver = sources.of_receivers[p];
        LocalReceiver receiver;
        receiver.sources.resize(local_mask_bytes(sources.sources.size()));
        receiver.first_pair = static_cast<std::uint32_t>(transfer.pairs.size());
        float most = 0;
        for (std::size_t n = 0; n < of_receiver.size(); ++n) {
            const float scale = scale_of_exponent(transfer.sources[of_receiver[n]].exponent);
            most = std::max(most, largest(light.pairs[p][n]) / scale);
        }
        receiver.exponent = static_cast<std::int8_t>(exponent_of(most, min_exponent));
        for (std::size_t n = 0; n < of_receiver.size(); ++n) {
            const std::uint32_t s = of_receiver[n];
            const float scale = scale_of_exponent(receiver.exponent + transfer.sources[s].exponent);
            LightCodes codes{};
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i)
                    codes[c][i] = encode_fixed(light.pairs[p][n][c][i], scale);
            }
            round_codes(codes);
            if (codes == LightCodes{})
                continue;
            receiver.sources[s >> 3] = static_cast<std::uint8_t>(receiver.sources[s >> 3] | 1u << (s & 7));
            transfer.pairs.push_back(codes);
        }
        transfer.receivers.push_back(std::move(receiver));
    }
    return transfer;
}

}  // namespace drtv::bake
