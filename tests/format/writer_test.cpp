#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

namespace drtv::test {
namespace {

constexpr std::array<std::size_t, 7> probe_counts = {0, 1, 2, 3, 70, 254, 255};

class SectorWriter : public testing::TestWithParam<Codec> {
  protected:
    [[nodiscard]] static Bytes write(const Sector& sector) { return write_sector(sector, {GetParam()}); }
};

TEST_P(SectorWriter, WhatIsWrittenIsReadBack) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        const Sector sector = random_sector(seed, seed < 7 ? probe_counts[seed] : seed * 6);
        Sector read;
        const ReadStatus status = read_sector(write(sector), read);
        ASSERT_TRUE(status.ok()) << "seed " << seed << ": " << status.message;
        ASSERT_EQ(read, sector) << "seed " << seed;
    }
}

TEST_P(SectorWriter, WhatIsReadIsWrittenAsTheSameBytes) {
    for (std::size_t count : probe_counts) {
        const Bytes bytes = write(random_sector(99, count));
        Sector read;
        ASSERT_TRUE(read_sector(bytes, read).ok());
        ASSERT_EQ(write(read), bytes);
    }
}

TEST_P(SectorWriter, ValidSectorPassesTheValidator) {
    for (std::size_t count : probe_counts) {
        for (const Finding& finding : validate_sector(write(random_sector(5, count)))) {
            ADD_FAILURE() << count << " probes: " << finding.issue->code << ' ' << finding.path << ' ' << finding.message;
        }
    }
}

TEST_P(SectorWriter, SectionsAreAlignedAndInTheOrderOfKinds) {
    std::vector<SectionEntry> entries;
    const Bytes bytes = write(random_sector(1, 33));
    ASSERT_TRUE(read_section_table(bytes, entries).ok());
    ASSERT_EQ(entries.size(), 6u);
    for (std::size_t n = 0; n < entries.size(); ++n) {
        EXPECT_EQ(entries[n].kind, n + 1);
        EXPECT_EQ(entries[n].version, 1);
        EXPECT_EQ(entries[n].offset % 16, 0u);
    }
    EXPECT_EQ(entries.back().offset + entries.back().stored_bytes, bytes.size());
}

INSTANTIATE_TEST_SUITE_P(, SectorWriter, testing::Values(Codec::raw, Codec::zstd),
                         [](const auto& codec) { return codec.param == Codec::raw ? "raw" : "zstd"; });

TEST(SectorSize, OfSeventyProbesIsWithinTheSeedsBudget) {
    EXPECT_EQ(write_sector(random_sector(1, 70)).size(), 256u + 48 + 560 + 560 + 6720 + 4112 + 40);
    EXPECT_LE(write_sector(random_sector(1, 70)).size(), 15u * 1024);
}

TEST(SectorSize, ZstdIsUsedOnlyWhereItMakesASectionSmaller) {
    const Bytes bytes = write_sector(golden_sector(), {Codec::zstd});
    EXPECT_LT(bytes.size(), golden_bytes().size() / 4);
    std::vector<SectionEntry> entries;
    ASSERT_TRUE(read_section_table(bytes, entries).ok());
    std::size_t packed = 0;
    for (const SectionEntry& entry : entries) {
        if (entry.codec == 0) {
            EXPECT_EQ(entry.stored_bytes, entry.raw_bytes);
        } else {
            EXPECT_LT(entry.stored_bytes, entry.raw_bytes);
            ++packed;
        }
    }
    EXPECT_GT(packed, 0u);
    EXPECT_LT(packed, entries.size());
}

}  // namespace
}  // namespace drtv::test
