// Damage without aim: cut files, grown files, single bits, and random damage under correct checksums.
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

namespace drtv::test {
namespace {

struct Kind {
    const char* name;
    Codec codec;
    Sector (*sector)();
    // Where rules stand close together: a section's kind and an offset in it.
    std::vector<std::pair<std::uint16_t, std::size_t>> telling;
};

class DamagedSector : public testing::TestWithParam<Kind> {
  protected:
    const Bytes file = write_sector(GetParam().sector(), {GetParam().codec});
    Sector sector;
};

TEST_P(DamagedSector, EveryPrefixIsRejected) {
    for (std::size_t size = 0; size < file.size(); ++size) {
        // Its own block, so that the sanitizer sees a read behind its end.
        const Bytes prefix(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
        const ReadStatus status = read_sector(prefix, sector);
        ASSERT_EQ(status.error, size < 4 ? ReadError::not_a_sector_file : ReadError::truncated) << size;
    }
}

TEST_P(DamagedSector, OneExtraByteIsRejected) {
    for (unsigned byte = 0; byte < 256; ++byte) {
        Bytes longer = file;
        longer.push_back(static_cast<std::uint8_t>(byte));
        ASSERT_EQ(read_sector(longer, sector).error, ReadError::trailing_bytes);
    }
}

TEST_P(DamagedSector, EverySingleBitFlipIsRejected) {
    Bytes flipped = file;
    for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
        const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
        flipped[bit / 8] ^= mask;
        // The minor version is no rule of its own, but the header's checksum covers it.
        ASSERT_FALSE(read_sector(flipped, sector).ok()) << "byte " << bit / 8 << " bit " << bit % 8;
        flipped[bit / 8] ^= mask;
    }
    EXPECT_TRUE(read_sector(flipped, sector).ok());
}

// Under right checksums the deeper rules are reached. What is accepted must be a sector that can be written
// and read.
TEST_P(DamagedSector, RandomDamageUnderRightChecksumsIsRejectedOrASector) {
    std::mt19937 random(3);
    std::vector<std::size_t> starts;
    for (const auto& [kind, offset] : GetParam().telling)
        starts.push_back(section_start(file, kind) + offset);
    std::size_t accepted = 0, rejected = 0;
    for (int round = 0; round < 1500; ++round) {
        Edit edit(file);
        for (std::uint32_t n = 0; n <= random() % 3; ++n) {
            const std::size_t where = random() % 4;
            const std::size_t offset =
                where == 0   ? random() % 256
                : where == 1 ? std::min(starts[random() % starts.size()] + random() % 24, file.size() - 1)
                             : random() % file.size();
            constexpr std::array<std::uint8_t, 6> telling = {0, 1, 0x7F, 0x80, 0xFE, 0xFF};
            edit.u8(offset, random() % 2 == 0 ? telling[random() % telling.size()] : random() % 256);
        }
        const Bytes damaged = random() % 8 == 0 ? edit.as_is() : edit.sealed();
        Sector read;
        const ReadStatus status = read_sector(damaged, read);
        const auto findings = validate_sector(damaged).findings;
        for (const Finding& finding : findings)
            ASSERT_LE(finding.offset, damaged.size());
        if (!status.ok()) {
            ASSERT_LE(status.offset, damaged.size());
            ASSERT_FALSE(findings.empty());
            ++rejected;
            continue;
        }
        Sector again;
        ASSERT_TRUE(read_sector(write_sector(read), again).ok());
        ASSERT_EQ(write_sector(again), write_sector(read));
        ++accepted;
    }
    // Both ways were walked.
    EXPECT_GT(accepted, 20u);
    EXPECT_GT(rejected, 200u);
}

const std::vector<std::pair<std::uint16_t, std::size_t>> required = {{1, 0}, {2, 0}, {5, 0}, {6, 0}};
// Of local transfer: header, sources, receivers, masks.
const std::vector<std::pair<std::uint16_t, std::size_t>> optional = {{2, 0},  {7, 64}, {8, 0},  {8, 16},
                                                                     {8, 32}, {8, 64}, {8, 96}, {9, 0}};

const std::vector<std::pair<std::uint16_t, std::size_t>> latest = {{8, 0},    {11, 0}, {11, 16}, {11, 80},
                                                                   {11, 144}, {12, 0}, {12, 16}, {12, 40}};

INSTANTIATE_TEST_SUITE_P(, DamagedSector,
                         testing::Values(Kind{"raw", Codec::raw, golden_sector, required},
                                         Kind{"zstd", Codec::zstd, golden_sector, required},
                                         Kind{"raw_1_1", Codec::raw, golden_sector_1_1, optional},
                                         Kind{"zstd_1_1", Codec::zstd, golden_sector_1_1, optional},
                                         Kind{"raw_1_3", Codec::raw, golden_sector_1_3, latest},
                                         Kind{"zstd_1_3", Codec::zstd, golden_sector_1_3, latest}),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace drtv::test
