// Rounding of local transfer: to 8 significant bits of a pair, and still valid.
#include "bakerd/bake/local_encoding.h"
#include "tests/bake/worlds.h"

#include <drtv/validate.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <random>

namespace drtv::test {
namespace {

constexpr std::size_t probes = 12;

bake::LocalSources sources_in_a_row() {
    bake::LocalSources sources;
    for (std::size_t p = 0; p < probes; ++p) {
        sources.sources.push_back({0, 0, static_cast<std::uint8_t>(p), 0});
        sources.positions.emplace_back(static_cast<int>(p) * 4096, 0, 0);
    }
    sources.of_receivers = all_pairs(probes);
    return sources;
}

// Light over many decades, band 1 often at its bound of 1.1547 times band 0.
bake::LocalLight random_light(unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<float>(random() % 10001) / 10000; };
    bake::LocalLight light;
    light.pairs.assign(probes, std::vector<bake::LocalCoefficients>(probes));
    for (std::size_t n = 0; n < probes * probes; ++n) {
        const float strength = std::pow(10.0f, -6 * uniform());
        for (auto& channel : light.pairs[n / probes][n % probes]) {
            channel[0] = strength * uniform();
            for (std::size_t i = 1; i < sh_count; ++i)
                channel[i] = channel[0] * 1.1547f * (random() % 3 == 0 ? 1 : 2 * uniform() - 1);
        }
    }
    return light;
}

TEST(LocalEncoding, KeepsEightBitsOfAPairsLargest) {
    const bake::LocalSources sources = sources_in_a_row();
    for (unsigned seed = 0; seed < 20; ++seed) {
        const bake::LocalLight light = random_light(seed);
        const LocalTransfer local = bake::encode_local(sources, light);
        std::size_t pair = 0, coarse = 0;
        for (std::size_t p = 0; p < probes; ++p) {
            for (std::size_t s = 0; s < probes; ++s) {
                if (!has_pair(local.receivers[p], s))
                    continue;
                const LightCodes& codes = local.pairs[pair++];
                int most = 0, bits = 0;
                for (const auto& channel : codes) {
                    for (const std::int16_t q : channel) {
                        most = std::max(most, std::abs(int{q}));
                        bits |= std::abs(int{q});
                    }
                }
                const int step = 1 << std::countr_zero(static_cast<unsigned>(bits));
                // 9 bits only where rounding carried into a new one.
                ASSERT_TRUE(most / step < 256 || most / step == 256) << most << " in steps of " << step;
                coarse += step > 1 ? 1u : 0u;
                const float scale =
                    scale_of_exponent(local.receivers[p].exponent + local.sources[s].exponent);
                // Half a step for rounding, one more where band 1 was taken below its bound, half a code for
                // fixed point.
                const float allowed = scale / fixed_point_max * (1.5f * static_cast<float>(step) + 0.5f);
                for (std::size_t c = 0; c < channel_count; ++c) {
                    for (std::size_t i = 0; i < sh_count; ++i)
                        ASSERT_NEAR(decode_fixed(codes[c][i], scale), light.pairs[p][s][c][i],
                                    allowed + std::abs(light.pairs[p][s][c][i]) * 1e-4f);
                }
            }
        }
        EXPECT_GT(coarse, 20u) << "nothing was rounded";
    }
}

TEST(LocalEncoding, RoundedPairsAreValid) {
    const bake::LocalSources sources = sources_in_a_row();
    for (unsigned seed = 0; seed < 50; ++seed) {
        Sector sector;
        sector.probes.resize(probes);
        sector.local_transfer = bake::encode_local(sources, random_light(seed));
        for (const Finding& finding :
             validate_sector(write_sector(sector), {.max_findings = 10'000}).findings) {
            EXPECT_NE(finding.issue, &issue::local_transfer_range) << finding.path << " " << finding.message;
            EXPECT_NE(finding.issue, &issue::fixed_point_reserved) << finding.path;
        }
    }
}

}  // namespace
}  // namespace drtv::test
