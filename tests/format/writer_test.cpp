#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

namespace drtv::test {
namespace {

constexpr std::array<std::size_t, 7> probe_counts = {0, 1, 2, 3, 70, 254, 255};

struct Kind {
    const char* name;
    Codec codec;
    Sector (*sector)(std::uint32_t seed, std::size_t probe_count);
    std::uint16_t minor;
    std::size_t sections;
};

class SectorWriter : public testing::TestWithParam<Kind> {
  protected:
    [[nodiscard]] static Bytes write(const Sector& sector) {
        return write_sector(sector, {GetParam().codec});
    }
    [[nodiscard]] static Sector make(std::uint32_t seed, std::size_t probe_count) {
        return GetParam().sector(seed, probe_count);
    }
};

TEST_P(SectorWriter, WhatIsWrittenIsReadBack) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        const Sector sector = make(seed, seed < 7 ? probe_counts[seed] : seed * 6);
        Sector read;
        const ReadStatus status = read_sector(write(sector), read);
        ASSERT_TRUE(status.ok()) << "seed " << seed << ": " << status.message;
        ASSERT_EQ(read, sector) << "seed " << seed;
    }
}

TEST_P(SectorWriter, WhatIsReadIsWrittenAsTheSameBytes) {
    for (std::size_t count : probe_counts) {
        const Bytes bytes = write(make(99, count));
        Sector read;
        ASSERT_TRUE(read_sector(bytes, read).ok());
        ASSERT_EQ(write(read), bytes);
    }
}

TEST_P(SectorWriter, ValidSectorPassesTheValidator) {
    for (std::size_t count : probe_counts) {
        for (const Finding& finding : validate_sector(write(make(5, count))).findings) {
            ADD_FAILURE() << count << " probes: " << finding.issue->code << ' ' << finding.path << ' '
                          << finding.message;
        }
    }
}

TEST_P(SectorWriter, SectionsAreAlignedAndInTheOrderOfKinds) {
    std::vector<SectionEntry> entries;
    const Bytes bytes = write(make(1, 33));
    ASSERT_TRUE(read_section_table(bytes, entries).ok());
    ASSERT_EQ(entries.size(), GetParam().sections);
    for (std::size_t n = 0; n < entries.size(); ++n) {
        EXPECT_EQ(entries[n].kind, n + 1);
        const std::uint16_t filtered = GetParam().minor == 3 ? 3 : 2;
        if (entries[n].kind != 8 || GetParam().minor < 3)
            EXPECT_EQ(entries[n].version, entries[n].codec == 2 ? filtered : 1);
        else
            EXPECT_EQ(entries[n].version, 3);
        EXPECT_EQ(entries[n].offset % 16, 0u);
    }
    EXPECT_EQ(entries.back().offset + entries.back().stored_bytes, bytes.size());
}

TEST_P(SectorWriter, FileHasTheLeastVersionThatItsSectionsNeed) {
    EXPECT_EQ(get(write(make(1, 3)), at::minor, 2), GetParam().minor);
}

INSTANTIATE_TEST_SUITE_P(, SectorWriter,
                         testing::Values(Kind{"raw", Codec::raw, random_sector, 0, 6},
                                         Kind{"zstd", Codec::zstd, random_sector, 0, 6},
                                         Kind{"raw_1_1", Codec::raw, random_sector_1_1, 1, 9},
                                         Kind{"zstd_1_1", Codec::zstd, random_sector_1_1, 2, 9},
                                         Kind{"raw_1_2", Codec::raw, random_sector_1_2, 2, 10},
                                         Kind{"zstd_1_2", Codec::zstd, random_sector_1_2, 2, 10},
                                         Kind{"raw_1_3", Codec::raw, random_sector_1_3, 3, 12},
                                         Kind{"zstd_1_3", Codec::zstd, random_sector_1_3, 3, 12}),
                         [](const auto& kind) { return kind.param.name; });

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
