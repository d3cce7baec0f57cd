// A case for each rule of the interiors section, and of local transfer that is filtered.
#include "tests/format/rejection.h"

#include <drtv/write.h>

namespace drtv::test {
namespace {

const Bytes good = golden_bytes_1_2();
const Bytes packed = write_sector(golden_sector_1_2(), {Codec::zstd});

// In the golden file of 1.2: two interiors, of 8 and 9 vertices, 12 and 14 triangles. Parts at 0, 16, 80,
// 192.
constexpr std::size_t start = 5312, first = start + 16, second = start + 48, vertices_end = start + 80 + 102,
                      triangles = start + 192;
constexpr std::uint16_t kind = 10;

Edit edit() {
    return Edit(good);
}

Bytes with_raw(const Bytes& raw) {
    std::vector<Section> sections = sections_of(good);
    for (Section& section : sections) {
        if (section.kind == kind)
            section = {kind, 1, 0, static_cast<std::uint32_t>(raw.size()), raw};
    }
    return with_sections(good, sections);
}

Bytes resized(int by) {
    Bytes raw = stored_of(good, kind);
    raw.resize(raw.size() + static_cast<std::size_t>(by));
    return raw;
}

// The filtered planes of the golden local transfer, changed, in a frame of their own.
Bytes with_planes(const std::function<void(Bytes&)>& change) {
    // 112 bytes as they are, 5 shifts, 5 classes, 60 high and 60 low bytes.
    Bytes planes = stored_of(good, 8);
    planes.resize(112 + 5 * 26);
    std::fill(planes.begin() + 112, planes.end(), std::uint8_t{0});
    change(planes);
    std::vector<Section> sections = sections_of(packed);
    for (Section& section : sections) {
        if (section.kind == 8)
            section = {8, 2, 2, 232, zstd_frame(planes)};
    }
    return with_sections(packed, sections);
}

const std::vector<Rejection> cases = {
    {"WithoutHeader", ReadError::bad_section, start,
     "interiors section (kind 10) has 15 bytes, must have 16 to", [] { return with_raw(Bytes(15)); }},
    {"UnknownCodec", ReadError::bad_section, start, "unknown codec 2",
     [] { return edit().u8(entry(9) + at::codec, 2).sealed(); }},
    {"TooMany", ReadError::bad_section, start, "1025 interiors are over the limit of 1024",
     [] { return edit().u16(start, 1025).sealed(); }},
    {"ReservedInHeader", ReadError::bad_section, start + 2, "reserved",
     [] { return edit().u8(start + 2, 1).sealed(); }},
    {"ReservedBehindHeader", ReadError::bad_section, start + 2, "reserved",
     [] { return edit().u8(start + 15, 1).sealed(); }},
    {"TooManyTriangles", ReadError::bad_section, start + 8, "262145 triangles are over the limit",
     [] { return edit().u32(start + 8, 262145).sealed(); }},
    {"VerticesBeyondTheSection", ReadError::bad_section, start + 4, "must have",
     [] { return edit().u32(start + 4, 0xFFFFFFFF).sealed(); }},
    {"TooShort", ReadError::bad_section, start + 4, "has 347 bytes, must have 348",
     [] { return with_raw(resized(-1)); }},
    {"TooLong", ReadError::bad_section, start + 4, "has 349 bytes, must have 348",
     [] { return with_raw(resized(1)); }},
    {"OriginTooFar", ReadError::bad_section, first + 4, "interior 0: its origin 2147483647",
     [] { return edit().u32(first + 4, 0x7FFFFFFF).sealed(); }},
    {"OriginTooFarDown", ReadError::bad_section, second + 8, "interior 1: its origin -2147483648",
     [] { return edit().u32(second + 8, 0x80000000).sealed(); }},
    {"ShiftTooLarge", ReadError::bad_section, second + 12, "its shift 11 is over the limit of 10",
     [] { return edit().u8(second + 12, 11).sealed(); }},
    {"NoSuchProbe", ReadError::bad_section, first + 13, "interior 0 uses probe 3, the sector has 3",
     [] { return edit().u8(first + 13, 3).sealed(); }},
    {"ReservedInEntry", ReadError::bad_section, first + 14, "interior 0: its reserved",
     [] { return edit().u8(first + 15, 1).sealed(); }},
    {"FirstVertexElsewhere", ReadError::bad_section, second + 16,
     "interior 1 begins at vertex 7, those before it have 8",
     [] { return edit().u32(second + 16, 7).sealed(); }},
    {"TooManyVerticesOfOne", ReadError::bad_section, first + 20, "65537 vertices",
     [] { return edit().u32(first + 20, 65537).sealed(); }},
    {"FirstTriangleElsewhere", ReadError::bad_section, second + 24,
     "interior 1 begins at triangle 13, those before it have 12",
     [] { return edit().u32(second + 24, 13).sealed(); }},
    {"MoreTrianglesThanAll", ReadError::bad_section, first + 28,
     "interior 0 has 27 triangles, more than the header leaves",
     [] { return edit().u32(first + 28, 27).sealed(); }},
    {"VertexOfAnother", ReadError::bad_section, triangles + 2, "interior 0: triangle 0 has the vertex 8 of 8",
     [] { return edit().u16(triangles + 2, 8).sealed(); }},
    {"MoreVerticesThanTheHeaderSays", ReadError::bad_section, start + 4,
     "the header says 17 vertices, its interiors have 18",
     [] { return edit().u32(second + 20, 10).sealed(); }},
    {"FewerTrianglesThanTheHeaderSays", ReadError::bad_section, start + 8,
     "the header says 26 triangles, its interiors have 25",
     [] { return edit().u32(second + 28, 13).sealed(); }},
    {"PaddingBehindVertices", ReadError::bad_section, vertices_end, "padding behind the vertices",
     [] { return edit().u8(vertices_end + 9, 1).sealed(); }},

    {"FilteredWithPlainZstd", ReadError::bad_section, section_start(packed, 8),
     "of version 2 has the unknown codec 1",
     [] { return Edit(packed).u8(entry(7) + at::codec, 1).sealed(); }},
    {"FilteredOfVersion1", ReadError::bad_section, section_start(packed, 8),
     "of version 1 has the unknown codec 2",
     [] { return Edit(packed).u16(entry(7) + at::version, 1).sealed(); }},
    {"FilteredTooShort", ReadError::bad_section, section_start(packed, 8), "not a filtered section",
     [] { return with_planes([](Bytes& planes) { planes.pop_back(); }); }},
    {"FilteredTooLong", ReadError::bad_section, section_start(packed, 8), "does not decode",
     [] { return with_planes([](Bytes& planes) { planes.resize(1000); }); }},
    {"FilteredShiftTooLarge", ReadError::bad_section, section_start(packed, 8), "not a filtered section",
     [] { return with_planes([](Bytes& planes) { planes[112] = 16; }); }},
    {"FilteredClassTooLarge", ReadError::bad_section, section_start(packed, 8), "not a filtered section",
     [] { return with_planes([](Bytes& planes) { planes[121] = 17; }); }},
    {"FilteredOfOtherPairs", ReadError::bad_section, section_start(packed, 8), "not a filtered section",
     [] { return with_planes([](Bytes& planes) { planes[4] = 6; }); }},
};

class InteriorsReader : public testing::TestWithParam<Rejection> {};

TEST_P(InteriorsReader, IsRejected) {
    expect_rejected(GetParam());
}

INSTANTIATE_TEST_SUITE_P(, InteriorsReader, testing::ValuesIn(cases),
                         [](const auto& c) { return c.param.name; });

TEST(InteriorsVersions, SectionOfALaterVersionOrAnEarlierFileIsIgnored) {
    for (const Bytes& file :
         {edit().u16(entry(9) + at::version, 2).sealed(), edit().u16(at::minor, 1).sealed()}) {
        Sector sector;
        const ReadStatus status = read_sector(file, sector);
        EXPECT_TRUE(status.ok()) << status.message;
        EXPECT_EQ(sector, golden_sector_1_1());
    }
}

// Readers of 1.1 skip it: they ignore another version of the kinds 7 to 9.
TEST(FilteredLocalTransfer, InAFileOf11IsIgnored) {
    Sector expected = golden_sector_1_1(), sector;
    expected.local_transfer.reset();
    const ReadStatus status = read_sector(Edit(packed).u16(at::minor, 1).sealed(), sector);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(sector, expected);
}

}  // namespace
}  // namespace drtv::test
