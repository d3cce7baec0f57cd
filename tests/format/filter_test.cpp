// The filter of local transfer against its description, and back and forth over everything that codes can be.
#include "format/src/local_filter.h"
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/write.h>

#include <gtest/gtest.h>

#include <random>
#include <tuple>

namespace drtv::test {
namespace {

Bytes local_section(const Sector& sector) {
    return stored_of(write_sector(sector), 8);
}

Bytes back(const Bytes& filtered, std::size_t probes, std::size_t raw_bytes) {
    Bytes raw;
    EXPECT_TRUE(unfilter_local(filtered, probes, max_sector_sources, raw_bytes, raw));
    return raw;
}

TEST(LocalFilter, GivesBackEverySection) {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const Bytes raw = local_section(random_sector_1_1(seed, 1 + seed * 20));
        EXPECT_EQ(back(filter_local(raw, 1 + seed * 20), 1 + seed * 20, raw.size()), raw) << seed;
        const Bytes many = local_section(random_sector_1_3(seed, 1 + seed * 20));
        const Bytes filtered = filter_local(many, 1 + seed * 20);
        EXPECT_EQ(back(filtered, 1 + seed * 20, many.size()), many) << seed;
        Bytes out;
        EXPECT_FALSE(unfilter_local(filtered, 1 + seed * 20, max_probes, many.size(), out)) << seed;
    }
}

// Invalid codes too: a reader must give what the file says.
TEST(LocalFilter, GivesBackCodesOfAnyKind) {
    std::mt19937 random(7);
    Sector sector = random_sector_1_1(5, 40);
    constexpr std::array<std::int16_t, 9> telling = {0, 1, -1, 2, 255, -256, 32767, -32767, INT16_MIN};
    for (LightCodes& pair : sector.local_transfer->pairs) {
        const unsigned shift = random() % 16;
        for (auto& channel : pair) {
            for (std::int16_t& q : channel)
                q = random() % 2 == 0 ? telling[random() % telling.size()]
                                      : static_cast<std::int16_t>(static_cast<unsigned>(random()) << shift);
        }
    }
    const Bytes raw = local_section(sector);
    EXPECT_EQ(back(filter_local(raw, 40), 40, raw.size()), raw);
}

// Two pairs by hand, after SPEC.md section 5.10.
TEST(LocalFilter, PutsBytesWhereThePageSays) {
    Sector sector = golden_sector();
    LocalTransfer& local = sector.local_transfer.emplace();
    local.sources = {{0, 0, 0, 0}, {0, 0, 1, 0}};
    local.receivers.resize(2);
    // Shift 4: green (100, -20, 30, 40), red (52, -10, 15, 21), blue (90, 0, 0, 0). The largest has 7 bits.
    add_pairs(local, 0, {1},
              {{{52 * 16, -10 * 16, 15 * 16, 21 * 16},
                {100 * 16, -20 * 16, 30 * 16, 40 * 16},
                {90 * 16, 0, 0, 0}}});
    // Shift 0, 9 bits. The sums are now green 1 - 0 + 100 = 101, red 53, blue 91.
    add_pairs(local, 1, {0}, {{{160, 0, 0, 0}, {300, 0, 1, 0}, {270, 0, 0, 0}}});
    const Bytes raw = local_section(sector), filtered = filter_local(raw, 2);
    const std::size_t codes = raw.size() - 2 * 24;
    ASSERT_EQ(filtered.size(), codes + 2 * 26);
    EXPECT_TRUE(std::equal(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(codes), filtered.begin()));
    const std::uint8_t* at = filtered.data() + codes;
    EXPECT_EQ(Bytes(at, at + 4), (Bytes{4, 0, 7, 9}));
    const auto zigzag = [](int value) {
        return static_cast<std::uint16_t>(value < 0 ? -2 * value - 1 : 2 * value);
    };
    // Red is foretold from 1 : 1 sums as 100, its band 1 as round(-20 * 52 / 100) = -10, 16, 21; blue as 100,
    // then -18, 27, 36.
    const std::array<int, 12> first = {100, -20, 30, 40, 52 - 100, 0, -1, 0, 90 - 100, 18, -27, -36};
    // (300 * 53 + 50) / 101 = 157; blue (300 * 91 + 50) / 101 = 270. Band 1 of red: 1 * 160 / 300 rounds
    // to 1.
    const std::array<int, 12> second = {300, 0, 1, 0, 160 - 157, 0, -1, 0, 270 - 270, 0, -1, 0};
    // Groups by class + bits off, then class, then number: of the pair of 7 bits (a) and that of 9 bits (b).
    constexpr std::array<int, 12> off = {1, -1, -1, -1, -2, -4, -4, -4, -2, -4, -4, -4};
    std::vector<int> expected;
    for (int bits = -4; bits <= 17; ++bits) {
        for (std::size_t k = 0; k < 12; ++k) {
            if (7 + off[k] == bits)
                expected.push_back(first[k]);
        }
        for (std::size_t k = 0; k < 12; ++k) {
            if (9 + off[k] == bits)
                expected.push_back(second[k]);
        }
    }
    ASSERT_EQ(expected.size(), 24u);
    const std::uint8_t *high = at + 4, *low = high + 24;
    for (std::size_t n = 0; n < 24; ++n)
        EXPECT_EQ(high[n] << 8 | low[n], zigzag(expected[n])) << n;
}

// Sums at their largest: what is foretold of red leaves 31 bits.
TEST(LocalFilter, LargestForetoldNumbersWrapAsThePageSays) {
    Sector sector = golden_sector();
    LocalTransfer& local = sector.local_transfer.emplace();
    local.sources = neighbouring_sources(5);
    local.receivers.resize(2);
    // s_r: 1, 32768, 57343, then 65538; s_g stays 1. Then 32767 * 65538 is foretold, and -32768 is there.
    for (const auto& [s, red, green] : {std::tuple<std::size_t, std::int16_t, std::int16_t>{0, 32767, -1},
                                        {1, 32767, 0},
                                        {2, 22530, -5},
                                        {3, INT16_MIN, 32767},
                                        {4, 32767, 1}}) {
        add_pairs(local, 0, {s}, {{{red, 1, 0, 0}, {green, 0, 0, 3}, {0, 0, 0, 0}}});
    }
    const Bytes raw = local_section(sector);
    EXPECT_EQ(back(filter_local(raw, 2), 2, raw.size()), raw);
}

TEST(LocalFilter, AnyBytesOfTheRightSizeGiveASectionOrNothing) {
    std::mt19937 random(11);
    const Bytes raw = local_section(random_sector_1_1(4, 9));
    const Bytes filtered = filter_local(raw, 9);
    std::size_t sections = 0;
    for (int round = 0; round < 3000; ++round) {
        Bytes damaged = filtered;
        for (int n = 0; n < 3; ++n)
            damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
        Bytes out;
        sections += unfilter_local(damaged, 9, max_probes, raw.size(), out) ? 1u : 0u;
        ASSERT_TRUE(out.empty() || out.size() == raw.size());
    }
    EXPECT_GT(sections, 1000u);
}

}  // namespace
}  // namespace drtv::test
