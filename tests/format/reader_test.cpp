// A case for each rule a reader checks: what is wrong, which error, at which byte, and a word of the message.
#include "tests/format/rejection.h"

#include <drtv/write.h>

#include <algorithm>

namespace drtv::test {
namespace {

const Bytes good = golden_bytes();

// In the golden file: 256 bake, 304 positions, 320 sky visibility, 336 transfer, 528 grid, 4640 statistics.
constexpr std::size_t bake_start = 256, positions_start = 304, sky_start = 320, grid_start = 528,
                      statistics_start = 4640;

Edit edit() {
    return Edit(good);
}

Bytes joined(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

const Bytes grid_frame = zstd_frame(stored_of(good, 5));
const Bytes skippable_frame = {0x50, 0x2A, 0x4D, 0x18, 1, 0, 0, 0, 0xAA};

const std::vector<Rejection> cases = {
    {"Nothing", ReadError::not_a_sector_file, 0, "DRTV", [] { return Bytes{}; }},
    {"ThreeBytes", ReadError::not_a_sector_file, 0, "DRTV", [] { return edit().cut(3).as_is(); }},
    {"OtherMagic", ReadError::not_a_sector_file, 0, "DRTV", [] { return edit().u8(0, 'd').sealed(); }},

    {"NewerMajor", ReadError::unsupported_version, 4,
     "version 2.7 is not supported: this reader knows version 1",
     [] { return edit().u16(4, 2).u16(6, 7).sealed(); }},
    {"NewerMajorOfOtherLayout", ReadError::unsupported_version, 4, "version 3.0",
     [] { return edit().u16(4, 3).cut(20).as_is(); }},
    {"MajorZero", ReadError::unsupported_version, 4, "version 0.0", [] { return edit().u16(4, 0).sealed(); }},
    {"NewerTransferSection", ReadError::unsupported_version, 336, "transfer section (kind 4) has version 2",
     [] { return edit().u16(entry(3) + at::version, 2).sealed(); }},

    {"HeaderCut", ReadError::truncated, 63, "the header needs 64 bytes, the file has 63",
     [] { return edit().cut(63).as_is(); }},
    {"TableCut", ReadError::truncated, 100, "4680 bytes, the file has 100",
     [] { return edit().cut(100).as_is(); }},
    {"LastByteCut", ReadError::truncated, 4679, "4680 bytes, the file has 4679",
     [] { return edit().cut(4679).as_is(); }},

    {"OneByteMore", ReadError::trailing_bytes, 4680, "4680 bytes, the file has 4681",
     [] { return edit().append(0).as_is(); }},

    {"SectionCountOverLimit", ReadError::bad_header, 12, "65 sections",
     [] { return edit().u32(at::section_count, 65).as_is(); }},
    {"SectionCountHuge", ReadError::bad_header, 12, "4294967295 sections",
     [] { return edit().u32(at::section_count, 0xFFFFFFFF).as_is(); }},
    {"TableLongerThanFile", ReadError::bad_header, 12, "6 sections",
     [] { return edit().cut(255).u32(at::file_bytes, 255).as_is(); }},
    {"SectorTooFarEast", ReadError::bad_header, 16, "(16385, 2)",
     [] { return edit().u32(at::sector_i, 16385).sealed(); }},
    {"SectorTooFarSouth", ReadError::bad_header, 20, "(-1, -16385)",
     [] { return edit().u32(at::sector_j, static_cast<std::uint32_t>(-16385)).sealed(); }},
    {"SectorLeastInteger", ReadError::bad_header, 16, "-2147483648",
     [] { return edit().u32(at::sector_i, 0x80000000).sealed(); }},
    {"ZOriginTooHigh", ReadError::bad_header, 24, "1073741825",
     [] { return edit().u32(at::z_origin, (1u << 30) + 1).sealed(); }},
    {"ZOriginLeastInteger", ReadError::bad_header, 24, "-2147483648",
     [] { return edit().u32(at::z_origin, 0x80000000).sealed(); }},
    {"TooManyProbes", ReadError::bad_header, 28, "probe count 256",
     [] { return edit().u16(at::probe_count, 256).sealed(); }},
    {"ZShiftTooLarge", ReadError::bad_header, 30, "z shift 11",
     [] { return edit().u8(at::z_shift, 11).sealed(); }},
    {"FirstReservedHeaderByte", ReadError::bad_header, 31, "reserved",
     [] { return edit().u8(31, 1).sealed(); }},
    {"LastReservedHeaderByte", ReadError::bad_header, 31, "reserved",
     [] { return edit().u8(55, 0x80).sealed(); }},

    {"ReservedEntryByte", ReadError::bad_table, entry(1), "positions section (kind 2)",
     [] { return edit().u8(entry(1) + 7, 1).sealed(); }},
    {"ReservedEntryWord", ReadError::bad_table, entry(2), "reserved",
     [] { return edit().u32(entry(2) + at::entry_reserved2, 1u << 31).sealed(); }},
    {"SectionElsewhere", ReadError::bad_table, entry(1), "starts at 320, must start at 304",
     [] { return edit().u32(entry(1) + at::offset, 320).sealed(); }},
    {"SectionOverlaps", ReadError::bad_table, entry(1), "starts at 256, must start at 304",
     [] { return edit().u32(entry(1) + at::offset, 256).sealed(); }},
    {"SectionPastTheEnd", ReadError::bad_table, entry(5), "ends at 4681, the file has 4680",
     [] { return edit().u32(entry(5) + at::stored_bytes, 41).u32(entry(5) + at::raw_bytes, 41).sealed(); }},
    {"SectionSizeHuge", ReadError::bad_table, entry(0), "ends at 4294967551",
     [] { return edit().u32(entry(0) + at::stored_bytes, 0xFFFFFFFF).sealed(); }},
    {"SectionDecodesToTooMuch", ReadError::bad_table, entry(4), "16777217 bytes",
     [] {
         return edit().u8(entry(4) + at::codec, 1).u32(entry(4) + at::raw_bytes, (1u << 24) + 1).sealed();
     }},
    {"RawSizesDiffer", ReadError::bad_table, entry(0), "48 stored and 47 raw",
     [] { return edit().u32(entry(0) + at::raw_bytes, 47).sealed(); }},
    {"PaddingNotZero", ReadError::bad_table, anywhere, "padding",
     [] {
         // An odd section in front, so that there is padding to spoil.
         Bytes file = with_one_more(good, {1000, 1, 0, 5, {1, 2, 3, 4, 5}});
         std::vector<Section> sections = sections_of(file);
         std::rotate(sections.begin(), sections.end() - 1, sections.end());
         file = with_sections(good, sections);
         return Edit(file).u8(section_start(file, 1000) + 5, 1).sealed();
     }},
    {"SectionTwice", ReadError::bad_table, entry(6), "grid section (kind 5) stands twice",
     [] { return with_one_more(good, sections_of(good)[4]); }},
    {"UnknownSectionTwice", ReadError::bad_table, entry(7), "unknown section (kind 77) stands twice",
     [] {
         std::vector<Section> sections = sections_of(good);
         sections.insert(sections.end(), 2, {77, 1, 0, 0, {}});
         return with_sections(good, sections);
     }},
    {"BytesBehindTheLastSection", ReadError::bad_table, 4680,
     "the last section ends at 4680, the file has 4681",
     [] { return edit().append(0).u32(at::file_bytes, 4681).sealed(); }},

    {"HeaderChanged", ReadError::checksum_mismatch, 56, "header",
     [] { return edit().u8(at::sector_i, 7).as_is(); }},
    {"TableChanged", ReadError::checksum_mismatch, 56, "header",
     [] { return edit().u8(entry(2) + at::raw_bytes, 7).as_is(); }},
    {"HeaderChecksumChanged", ReadError::checksum_mismatch, 56, "header",
     [] { return edit().u64(at::checksum, 1).as_is(); }},
    {"SectionChanged", ReadError::checksum_mismatch, sky_start, "sky visibility section (kind 3)",
     [] { return edit().u8(sky_start, 7).as_is(); }},

    {"NoSections", ReadError::missing_section, 0, "bake section", [] { return with_sections(good, {}); }},
    {"NoBake", ReadError::missing_section, 0, "bake section", [] { return without(good, 1); }},
    {"NoPositions", ReadError::missing_section, 0, "positions section", [] { return without(good, 2); }},
    {"NoSkyVisibility", ReadError::missing_section, 0, "sky visibility section",
     [] { return without(good, 3); }},
    {"NoTransfer", ReadError::missing_section, 0, "transfer section", [] { return without(good, 4); }},
    {"NoGrid", ReadError::missing_section, 0, "grid section", [] { return without(good, 5); }},
    {"NoStatistics", ReadError::missing_section, 0, "statistics section", [] { return without(good, 6); }},

    {"ProbeCountAgainstSections", ReadError::bad_section, positions_start,
     "positions section (kind 2) has 16 bytes, must have 24",
     [] { return edit().u16(at::probe_count, 3).sealed(); }},
    {"UnknownCodec", ReadError::bad_section, bake_start, "unknown codec 2",
     [] { return edit().u8(entry(0) + at::codec, 2).sealed(); }},
    {"NotZstd", ReadError::bad_section, grid_start, "not one whole zstd frame",
     [] {
         return with_stored(good, 5, 1, {1, 2, 3, 4, 5, 6});
     }},
    {"ZstdOfNoBytes", ReadError::bad_section, grid_start, "not one whole zstd frame",
     [] { return with_stored(good, 5, 1, {}); }},
    {"ZstdCut", ReadError::bad_section, grid_start, "not one whole zstd frame",
     [] { return with_stored(good, 5, 1, Bytes(grid_frame.begin(), grid_frame.end() - 1)); }},
    {"ZstdWithAByteBehind", ReadError::bad_section, grid_start, "not one whole zstd frame",
     [] { return with_stored(good, 5, 1, joined(grid_frame, {0})); }},
    {"ZstdTwoFrames", ReadError::bad_section, grid_start, "not one whole zstd frame",
     [] { return with_stored(good, 5, 1, joined(grid_frame, zstd_frame({}))); }},
    {"ZstdBehindSkippableFrame", ReadError::bad_section, grid_start, "not one whole zstd frame",
     [] { return with_stored(good, 5, 1, joined(skippable_frame, grid_frame)); }},
    {"ZstdOfTooFewBytes", ReadError::bad_section, grid_start, "does not decode to 4112 bytes",
     [] { return with_stored(good, 5, 1, zstd_frame(Bytes(4111))); }},
    {"ZstdOfTooManyBytes", ReadError::bad_section, grid_start, "does not decode to 4112 bytes",
     [] { return with_stored(good, 5, 1, zstd_frame(Bytes(4113))); }},
    {"ReachNotANumber", ReadError::bad_section, bake_start + 8, "reach",
     [] { return edit().u32(bake_start + 8, nan_bits).sealed(); }},
    {"MinimalDistanceInfinite", ReadError::bad_section, bake_start + 12, "minimal distance",
     [] { return edit().u32(bake_start + 12, infinity_bits).sealed(); }},
    {"UnknownProbeKind", ReadError::bad_section, positions_start + 8 + 6, "probe 1: kind 3",
     [] { return edit().u8(positions_start + 8 + 6, 3).sealed(); }},
    {"ReservedPositionByte", ReadError::bad_section, positions_start + 7, "probe 0: its reserved byte",
     [] { return edit().u8(positions_start + 7, 1).sealed(); }},
    {"UnknownProbeKindPacked", ReadError::bad_section, anywhere, "probe 1: kind 3",
     [] {
         return with_stored(good, 2, 1, zstd_frame([] {
                                Bytes raw = stored_of(good, 2);
                                raw[14] = 3;
                                return raw;
                            }()));
     }},
    {"GridOriginTooLow", ReadError::bad_section, grid_start, "-1073741825",
     [] { return edit().u32(grid_start, static_cast<std::uint32_t>(-(1 << 30) - 1)).sealed(); }},
    {"CellHeightZero", ReadError::bad_section, grid_start + 4, "cell height 0",
     [] { return edit().u32(grid_start + 4, 0).sealed(); }},
    {"CellHeightHuge", ReadError::bad_section, grid_start + 4, "cell height 16777217",
     [] { return edit().u32(grid_start + 4, (1u << 24) + 1).sealed(); }},
    {"ReservedGridByte", ReadError::bad_section, grid_start + 8, "reserved",
     [] { return edit().u8(grid_start + 15, 1).sealed(); }},
    {"UsedDistanceNotANumber", ReadError::bad_section, statistics_start + 20, "used distance",
     [] { return edit().u32(statistics_start + 20, nan_bits).sealed(); }},
};

class SectorReader : public testing::TestWithParam<Rejection> {};

TEST_P(SectorReader, IsRejected) {
    expect_rejected(GetParam());
}

INSTANTIATE_TEST_SUITE_P(, SectorReader, testing::ValuesIn(cases),
                         [](const auto& c) { return c.param.name; });

// No default: a new error without a case here is a warning, and warnings are errors.
ReadError after(ReadError error) {
    switch (error) {
        case ReadError::none:
            return ReadError::not_a_sector_file;
        case ReadError::not_a_sector_file:
            return ReadError::unsupported_version;
        case ReadError::unsupported_version:
            return ReadError::truncated;
        case ReadError::truncated:
            return ReadError::trailing_bytes;
        case ReadError::trailing_bytes:
            return ReadError::bad_header;
        case ReadError::bad_header:
            return ReadError::bad_table;
        case ReadError::bad_table:
            return ReadError::checksum_mismatch;
        case ReadError::checksum_mismatch:
            return ReadError::missing_section;
        case ReadError::missing_section:
            return ReadError::bad_section;
        case ReadError::bad_section:
        case ReadError::compressed:  // these two: view_test.cpp
        case ReadError::misaligned:
            return ReadError::none;
    }
    return ReadError::none;
}

TEST(ReadErrors, EachHasACase) {
    for (ReadError error = after(ReadError::none); error != ReadError::none; error = after(error)) {
        EXPECT_TRUE(
            std::any_of(cases.begin(), cases.end(), [&](const Rejection& c) { return c.error == error; }))
            << "error " << static_cast<int>(error);
    }
}

TEST(SectorReaderOffsets, PointAtTheFirstByteOfAPackedSection) {
    const Bytes file = with_stored(good, 5, 1, zstd_frame([] {
                                       Bytes raw = stored_of(good, 5);
                                       raw[4] = 0;
                                       raw[5] = 0;
                                       return raw;
                                   }()));
    Sector sector;
    EXPECT_EQ(read_sector(file, sector).offset, section_start(file, 5));
}

// What a later minor version may bring: an unknown section, of any version and codec, anywhere in the file.
TEST(SectorReaderVersions, NewerMinorWithUnknownSectionsIsRead) {
    std::vector<Section> sections = sections_of(good);
    sections.insert(sections.begin() + 2, {13, 1, 0, 3, {1, 2, 3}});
    sections.push_back({0xFFFF, 9, 200, 1u << 24, {4, 5}});
    const Bytes file = Edit(with_sections(good, sections)).u16(at::minor, 5).sealed();
    Sector sector;
    const ReadStatus status = read_sector(file, sector);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(sector, golden_sector());
    EXPECT_TRUE(validate_sector(file).valid());
    std::vector<SectionEntry> entries;
    ASSERT_TRUE(read_section_table(file, entries).ok());
    ASSERT_EQ(entries.size(), 8u);
    EXPECT_EQ(name_of_section(entries[2].kind), "unknown");
}

TEST(SectorReaderVersions, UnknownSectionIsStillCheckedAgainstItsChecksum) {
    const Bytes file = with_one_more(good, {1000, 1, 0, 3, {1, 2, 3}});
    Sector sector;
    EXPECT_EQ(read_sector(Edit(file).u8(file.size() - 1, 9).as_is(), sector).error,
              ReadError::checksum_mismatch);
}

TEST(SectorReaderVersions, SectionsInAnyOrderAreRead) {
    std::vector<Section> sections = sections_of(good);
    std::reverse(sections.begin(), sections.end());
    Sector sector;
    const ReadStatus status = read_sector(with_sections(good, sections), sector);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(sector, golden_sector());
}

TEST(SectorReaderLimits, SixtyFourSectionsAreRead) {
    std::vector<Section> sections = sections_of(good);
    while (sections.size() < 64)
        sections.push_back({static_cast<std::uint16_t>(100 + sections.size()), 1, 0, 0, {}});
    Sector sector;
    const ReadStatus status = read_sector(with_sections(good, sections), sector);
    EXPECT_TRUE(status.ok()) << status.message;
}

TEST(SectorReaderLimits, ExtremesAreRead) {
    Sector sector = golden_sector(), read;
    sector.i = max_sector_coordinate;
    sector.j = -max_sector_coordinate;
    sector.z_origin_units = -max_z_origin_units;
    sector.grid.z_origin_units = max_z_origin_units;
    sector.grid.cell_height_units = max_cell_height_units;
    sector.z_shift = max_z_shift;
    const ReadStatus status = read_sector(write_sector(sector), read);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(read, sector);
}

TEST(SectionNames, AreThoseOfTheSpecification) {
    constexpr std::array<std::string_view, 14> names = {
        "unknown",   "bake",         "positions",         "sky visibility", "transfer",
        "grid",      "statistics",   "static irradiance", "local transfer", "convergence",
        "interiors", "light groups", "quality",           "unknown"};
    for (std::uint16_t kind = 0; kind < names.size(); ++kind)
        EXPECT_EQ(name_of_section(kind), names[kind]);
}

}  // namespace
}  // namespace drtv::test
