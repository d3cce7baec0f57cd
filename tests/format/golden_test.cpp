// Frozen files: what was written once is read for ever, and the example in format/SPEC.md is such a file.
#include "tests/format/golden_files.h"
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/read.h>
#include <drtv/validate.h>

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace drtv::test {
namespace {

const std::string golden_folder = DRTV_SOURCE_DIR "/tests/data/golden/";

Bytes bytes_of(const GoldenFile& golden) {
    return read_test_file(golden_folder + golden.name + ".drtv");
}

TEST(GoldenFile, ReaderGivesTheSameNumbers) {
    for (const GoldenFile& golden : golden_files()) {
        Sector sector;
        const ReadStatus status = read_sector(bytes_of(golden), sector);
        EXPECT_TRUE(status.ok()) << golden.name << ": " << status.message;
        EXPECT_EQ(sector, golden.sector) << golden.name;
    }
}

// The bytes of a zstd frame differ from one version of zstd to the next: only the reader is held to those
// files.
TEST(GoldenFile, WriterGivesTheSameBytes) {
    for (const GoldenFile& golden : golden_files()) {
        if (golden.codec == Codec::raw) {
            EXPECT_EQ(write_sector(golden.sector), bytes_of(golden))
                << golden.name << ": a change of bytes needs another version of the format";
        }
    }
}

TEST(GoldenFile, IsValid) {
    for (const GoldenFile& golden : golden_files())
        EXPECT_EQ(validate_sector(bytes_of(golden)).findings.empty(), golden.valid) << golden.name;
}

TEST(GoldenFile, IsThereForEachVersionAndEachKind) {
    std::set<std::uint16_t> minors, kinds, codecs;
    for (const GoldenFile& golden : golden_files()) {
        std::vector<SectionEntry> entries;
        ASSERT_TRUE(read_section_table(bytes_of(golden), entries).ok());
        minors.insert(static_cast<std::uint16_t>(get(bytes_of(golden), at::minor, 2)));
        for (const SectionEntry& entry : entries) {
            kinds.insert(entry.kind);
            codecs.insert(entry.codec);
        }
    }
    EXPECT_EQ(minors, (std::set<std::uint16_t>{0, 1, 2, 3}));
    EXPECT_EQ(codecs, (std::set<std::uint16_t>{0, 1, 2}));
    EXPECT_EQ(kinds.size(), 12u);
    EXPECT_EQ(name_of_section(static_cast<std::uint16_t>(kinds.size() + 1)), "unknown")
        << "a new kind needs a golden file";
}

// Every byte is covered: by a checksum, or by the rule that padding is 0.
TEST(GoldenFile, EveryFlippedBitIsReported) {
    for (const char* name : {"format_1_0", "format_1_2", "format_1_2_zstd", "format_1_3"}) {
        Bytes flipped = read_test_file(golden_folder + name + ".drtv");
        ASSERT_FALSE(flipped.empty());
        for (std::size_t bit = 0; bit < 8 * flipped.size(); ++bit) {
            const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
            flipped[bit / 8] ^= mask;
            ASSERT_FALSE(validate_sector(flipped).valid())
                << name << ": byte " << bit / 8 << " bit " << bit % 8;
            flipped[bit / 8] ^= mask;
        }
    }
}

// The bytes of a listing as `hexdump -C` prints it: offset, 16 bytes, text; `*` repeats the line before.
Bytes bytes_of_listing(std::istream& listing) {
    Bytes bytes, last;
    bool repeat = false;
    for (std::string line; std::getline(listing, line) && line != "```";) {
        if (line == "*") {
            repeat = true;
            continue;
        }
        std::istringstream words(line.substr(0, line.find('|')));
        std::size_t offset = 0;
        words >> std::hex >> offset;
        while (repeat && bytes.size() < offset)
            bytes.insert(bytes.end(), last.begin(), last.end());
        repeat = false;
        EXPECT_EQ(bytes.size(), offset) << line;
        last.clear();
        for (unsigned byte = 0; words >> byte;)
            last.push_back(static_cast<std::uint8_t>(byte));
        bytes.insert(bytes.end(), last.begin(), last.end());
    }
    return bytes;
}

// The file of version 1.0, the local transfer section of that of version 1.1, the interiors of that of
// version 1.2, light groups and quality of that of version 1.3.
TEST(Specification, ExamplesAreTheGoldenFiles) {
    const std::vector<Bytes> expected = {golden_bytes(), stored_of(golden_bytes_1_1(), 8),
                                         stored_of(golden_bytes_1_2(), 10), stored_of(golden_bytes_1_3(), 11),
                                         stored_of(golden_bytes_1_3(), 12)};
    std::size_t listings = 0;
    std::ifstream page(DRTV_SOURCE_DIR "/format/SPEC.md");
    for (std::string line; std::getline(page, line);) {
        if (line != "```hexdump")
            continue;
        ASSERT_LT(listings, expected.size());
        EXPECT_EQ(bytes_of_listing(page), expected[listings++]);
    }
    EXPECT_EQ(listings, expected.size()) << "listings ```hexdump in format/SPEC.md";
}

}  // namespace
}  // namespace drtv::test
