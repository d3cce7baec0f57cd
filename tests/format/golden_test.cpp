// Frozen files: what was written once is read for ever, and the example in format/SPEC.md is such a file.
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/read.h>
#include <drtv/validate.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace drtv::test {
namespace {

const std::string golden_folder = DRTV_SOURCE_DIR "/tests/data/golden/";

Sector read_golden(const std::string& name) {
    Sector sector;
    const ReadStatus status = read_sector(read_test_file(golden_folder + name), sector);
    EXPECT_TRUE(status.ok()) << name << ": " << status.message;
    return sector;
}

TEST(GoldenFile, ReaderGivesTheSameNumbers) {
    EXPECT_EQ(read_golden("format_1_0.drtv"), golden_sector());
    EXPECT_EQ(read_golden("format_1_1.drtv"), golden_sector_1_1());
}

TEST(GoldenFile, WriterGivesTheSameBytes) {
    EXPECT_EQ(golden_bytes(), read_test_file(golden_folder + "format_1_0.drtv"));
    EXPECT_EQ(golden_bytes_1_1(), read_test_file(golden_folder + "format_1_1.drtv"));
}

// The bytes of a zstd frame differ from one version of zstd to the next: only the reader is held to this file.
TEST(GoldenFile, PackedFileGivesTheSameNumbers) {
    EXPECT_EQ(read_golden("format_1_0_zstd.drtv"), golden_sector());
    EXPECT_LT(read_test_file(golden_folder + "format_1_0_zstd.drtv").size(), 1000u);
}

TEST(GoldenFile, IsValid) {
    for (const char* name : {"format_1_0.drtv", "format_1_1.drtv"}) EXPECT_TRUE(validate_sector(read_test_file(golden_folder + name)).empty()) << name;
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
        while (repeat && bytes.size() < offset) bytes.insert(bytes.end(), last.begin(), last.end());
        repeat = false;
        EXPECT_EQ(bytes.size(), offset) << line;
        last.clear();
        for (unsigned byte = 0; words >> byte;) last.push_back(static_cast<std::uint8_t>(byte));
        bytes.insert(bytes.end(), last.begin(), last.end());
    }
    return bytes;
}

// The first listing is the file of version 1.0, the second the local transfer section of that of version 1.1.
TEST(Specification, ExamplesAreTheGoldenFiles) {
    const std::vector<Bytes> expected = {golden_bytes(), stored_of(golden_bytes_1_1(), 8)};
    std::size_t listings = 0;
    std::ifstream page(DRTV_SOURCE_DIR "/format/SPEC.md");
    for (std::string line; std::getline(page, line);) {
        if (line != "```hexdump") continue;
        ASSERT_LT(listings, expected.size());
        EXPECT_EQ(bytes_of_listing(page), expected[listings++]);
    }
    EXPECT_EQ(listings, expected.size()) << "listings ```hexdump in format/SPEC.md";
}

}  // namespace
}  // namespace drtv::test
