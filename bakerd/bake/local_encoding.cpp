#include "bakerd/bake/local_encoding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

namespace drtv::bake {
namespace {

constexpr int least_exponent = -60;  // of a source or of a receiver; no light is that faint

// Of a pair's largest code. A pair is known to 1 % at best, and this rounds it to 0.2 % of its largest: what
// it drops is noise, which would be most of a compressed file (CHANGELOG has the figures).
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

// The sources of one receiver, ascending.
std::vector<std::size_t> chosen_sources(const LocalSources& sources, std::size_t receiver, float reach_m) {
    std::vector<std::pair<std::int64_t, std::size_t>> by_distance;
    for (std::size_t s = 0; s < sources.positions.size(); ++s) {
        const std::int64_t square = square_distance(sources.positions[receiver], sources.positions[s]);
        if (square <= square_units(reach_m))
            by_distance.emplace_back(square, s);
    }
    std::ranges::sort(by_distance);
    by_distance.resize(std::min(by_distance.size(), max_local_sources));
    std::vector<std::size_t> chosen;
    for (const auto& [square, s] : by_distance)
        chosen.push_back(s);
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
    LocalSources sources;
    for (std::size_t p = 0; p < placed.positions.size(); ++p) {
        sources.sources.push_back({0, 0, static_cast<std::uint8_t>(p), 0});
        sources.positions.push_back(placed.positions[p]);
    }
    if (placed.positions.empty())
        return sources;
    struct Candidate {
        std::int64_t square;
        std::int32_t dj;
        std::int32_t di;
        std::uint32_t probe;
        placement::Position position;
    };
    std::vector<Candidate> candidates;
    for (const PlacedSector* neighbour : neighbours) {
        for (std::uint32_t p = 0; p < neighbour->positions.size(); ++p) {
            std::int64_t square = std::numeric_limits<std::int64_t>::max();
            for (const placement::Position& own : placed.positions)
                square = std::min(square, square_distance(own, neighbour->positions[p]));
            if (square <= square_units(reach_m))
                candidates.push_back({square,
                                      neighbour->sector.j - placed.sector.j,
                                      neighbour->sector.i - placed.sector.i,
                                      p,
                                      neighbour->positions[p]});
        }
    }
    std::ranges::sort(
        candidates, {}, [](const Candidate& c) { return std::tuple(c.square, c.dj, c.di, c.probe); });
    for (const Candidate& c : candidates) {
        if (sources.sources.size() >= max_local_sources)
            break;
        sources.sources.push_back({static_cast<std::int8_t>(c.di),
                                   static_cast<std::int8_t>(c.dj),
                                   static_cast<std::uint8_t>(c.probe),
                                   0});
        sources.positions.push_back(c.position);
    }
    return sources;
}

// A scale of a source and a receiver together: a source's is what its brightest receiver needs, a receiver's
// what its own strongest pair then still leaves unused. Each pair keeps at least the digits that either alone
// would give it.
LocalTransfer encode_local(const LocalSources& sources,
                           const LocalLight& light,
                           std::size_t receiver_count,
                           float reach_m) {
    LocalTransfer transfer;
    transfer.sources = sources.sources;
    std::vector<std::vector<std::size_t>> chosen;
    std::vector<float> brightest(sources.sources.size(), 0);
    for (std::size_t p = 0; p < receiver_count; ++p) {
        chosen.push_back(chosen_sources(sources, p, reach_m));
        for (const std::size_t s : chosen.back())
            brightest[s] = std::max(brightest[s], largest(light.at(p, s)));
    }
    for (std::size_t s = 0; s < brightest.size(); ++s)
        transfer.sources[s].exponent = static_cast<std::int8_t>(exponent_of(brightest[s], least_exponent));
    for (std::size_t p = 0; p < receiver_count; ++p) {
        LocalReceiver receiver;
        receiver.first_pair = static_cast<std::uint32_t>(transfer.pairs.size());
        float most = 0;
        for (const std::size_t s : chosen[p])
            most = std::max(most, largest(light.at(p, s)) / scale_of_exponent(transfer.sources[s].exponent));
        receiver.exponent = static_cast<std::int8_t>(exponent_of(most, least_exponent));
        for (const std::size_t s : chosen[p]) {
            const float scale = scale_of_exponent(receiver.exponent + transfer.sources[s].exponent);
            LightCodes codes{};
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i)
                    codes[c][i] = encode_fixed(light.at(p, s)[c][i], scale);
            }
            round_codes(codes);
            if (codes == LightCodes{})
                continue;
            receiver.sources[s >> 3] = static_cast<std::uint8_t>(receiver.sources[s >> 3] | 1u << (s & 7));
            transfer.pairs.push_back(codes);
        }
        transfer.receivers.push_back(receiver);
    }
    return transfer;
}

}  // namespace drtv::bake
