// A case for each rule of the optional sections, and what a reader makes of files of other versions that have
// them.
#include "tests/format/rejection.h"

#include <drtv/write.h>

namespace drtv::test {
namespace {

const Bytes good = golden_bytes_1_1();

// In the golden file of 1.1: three probes, three local sources, five pairs.
constexpr std::size_t static_start = 4912, local_start = 4992, convergence_start = 5232;
constexpr std::size_t sources_start = local_start + 16, receivers_start = local_start + 32,
                      masks_start = local_start + 64;
constexpr std::size_t static_entry = entry(6), local_entry = entry(7), convergence_entry = entry(8);

// In that of 1.3: 259 local sources, two light groups.
const Bytes latest = golden_bytes_1_3();
const std::size_t local_start_1_3 = section_start(latest, 8);
const std::size_t groups_start = section_start(latest, 11);
const std::size_t quality_start = section_start(latest, 12);

constexpr std::array<std::uint16_t, 3> light_kinds = {7, 8, 9};

Edit edit() {
    return Edit(good);
}

Bytes with_raw(std::uint16_t kind, const Bytes& raw) {
    std::vector<Section> sections = sections_of(good);
    for (Section& section : sections) {
        if (section.kind == kind)
            section = {kind, 1, 0, static_cast<std::uint32_t>(raw.size()), raw};
    }
    return with_sections(good, sections);
}

Bytes grown(Bytes bytes) {
    bytes.push_back(0);
    return bytes;
}

Bytes cut(Bytes bytes) {
    bytes.pop_back();
    return bytes;
}

// A section of nothing but its header.
Bytes local_header(std::uint64_t sources, std::uint64_t mask_bytes, std::uint64_t pairs) {
    return with_raw(8, Edit(Bytes(16)).u16(0, sources).u16(2, mask_bytes).u32(4, pairs).as_is());
}

const std::vector<Rejection> cases = {
    {"StaticIrradianceTooShort", ReadError::bad_section, static_start,
     "static irradiance section (kind 7) has 74 bytes, must have 75",
     [] { return with_raw(7, cut(stored_of(good, 7))); }},
    {"StaticIrradianceTooLong", ReadError::bad_section, static_start, "has 76 bytes, must have 75",
     [] { return with_raw(7, grown(stored_of(good, 7))); }},
    {"StaticIrradianceUnknownCodec", ReadError::bad_section, static_start, "unknown codec 2",
     [] { return edit().u8(static_entry + at::codec, 2).sealed(); }},

    {"LocalWithoutHeader", ReadError::bad_section, local_start,
     "local transfer section (kind 8) has 15 bytes, must have 16 to", [] { return with_raw(8, Bytes(15)); }},
    {"LocalOfNothing", ReadError::bad_section, local_start, "has 0 bytes, must have 16 to",
     [] { return with_raw(8, {}); }},
    // 16 + 1024 + 32 + 3 * 32 + 3 * 255 * 24 bytes is the most that three probes can have.
    {"LocalDecodesToTooMuch", ReadError::bad_section, local_start, "has 19529 bytes, must have 16 to 19528",
     [] {
         return Edit(with_stored(good, 8, 1, zstd_frame(Bytes(19529))))
             .u32(local_entry + at::raw_bytes, 19529)
             .sealed();
     }},
    {"LocalUnknownCodec", ReadError::bad_section, local_start, "unknown codec 9",
     [] { return edit().u8(local_entry + at::codec, 9).sealed(); }},
    {"LocalTooManySources", ReadError::bad_section, local_start, "256 sources are over the limit of 255",
     [] { return local_header(256, 32, 0); }},
    {"LocalMasksTooNarrow", ReadError::bad_section, local_start + 2,
     "masks of 16 bytes, must be of 32 for 129 sources", [] { return local_header(129, 16, 0); }},
    {"LocalMasksTooWide", ReadError::bad_section, local_start + 2,
     "masks of 32 bytes, must be of 16 for 128 sources", [] { return local_header(128, 32, 0); }},
    {"LocalReservedHeaderByte", ReadError::bad_section, local_start + 8, "reserved",
     [] { return edit().u8(local_start + 15, 1).sealed(); }},
    {"LocalHeaderWithoutItsParts", ReadError::bad_section, local_start + 4,
     "has 16 bytes, must have 112 for 3 sources and 0 pairs", [] { return local_header(3, 16, 0); }},
    {"LocalPairCountHuge", ReadError::bad_section, local_start + 4, "4294967295 pairs",
     [] { return local_header(3, 16, 0xFFFFFFFF); }},
    {"LocalTooLong", ReadError::bad_section, local_start + 4, "has 233 bytes, must have 232",
     [] { return with_raw(8, grown(stored_of(good, 8))); }},
    {"LocalTooShort", ReadError::bad_section, local_start + 4, "has 231 bytes, must have 232",
     [] { return with_raw(8, cut(stored_of(good, 8))); }},
    {"LocalSourceTooFarEast", ReadError::bad_section, sources_start + 8,
     "local source 2 stands in the sector (2, -1) away",
     [] { return edit().u8(sources_start + 8, 2).sealed(); }},
    {"LocalSourceTooFarSouth", ReadError::bad_section, sources_start + 8, "(1, -128) away",
     [] { return edit().u8(sources_start + 9, 0x80).sealed(); }},
    {"LocalSourceOfOwnSectorNotThere", ReadError::bad_section, sources_start + 2,
     "local source 0 is probe 3, its sector has at most 3",
     [] { return edit().u8(sources_start + 2, 3).sealed(); }},
    {"LocalSourceIsNoProbe", ReadError::bad_section, sources_start + 10,
     "local source 2 is probe 255, its sector has at most 255",
     [] { return edit().u8(sources_start + 10, 255).sealed(); }},
    {"LocalPaddingBehindSources", ReadError::bad_section, sources_start + 12, "padding behind the sources",
     [] { return edit().u8(sources_start + 15, 1).sealed(); }},
    {"LocalReservedReceiverByte", ReadError::bad_section, receivers_start + 8 + 5,
     "local receiver 1: its reserved", [] { return edit().u8(receivers_start + 8 + 7, 1).sealed(); }},
    {"LocalFirstPairNotZero", ReadError::bad_section, receivers_start,
     "local receiver 0 begins at pair 1, the masks before it have 0",
     [] { return edit().u32(receivers_start, 1).sealed(); }},
    {"LocalFirstPairOfAnother", ReadError::bad_section, receivers_start + 16,
     "local receiver 2 begins at pair 3, the masks before it have 4",
     [] { return edit().u32(receivers_start + 16, 3).sealed(); }},
    {"LocalPaddingBehindReceivers", ReadError::bad_section, receivers_start + 24,
     "padding behind the receivers", [] { return edit().u8(receivers_start + 24, 1).sealed(); }},
    {"LocalPairWithNoSource", ReadError::bad_section, masks_start,
     "local receiver 0 has a pair with source 3, the sector has 3",
     [] { return edit().u8(masks_start, 0x08).sealed(); }},
    {"LocalPairWithTheLastBitOfTheMask", ReadError::bad_section, masks_start + 47,
     "local receiver 2 has a pair with source 127",
     [] { return edit().u8(masks_start + 47, 0x80).sealed(); }},
    {"LocalFewerBitsThanPairs", ReadError::bad_section, local_start + 4,
     "the header says 5 pairs, the masks have 4", [] { return edit().u8(masks_start + 32, 0).sealed(); }},
    {"LocalMoreBitsThanPairs", ReadError::bad_section, local_start + 4,
     "the header says 5 pairs, the masks have 7", [] { return edit().u8(masks_start + 32, 7).sealed(); }},
    {"LocalPaddingNotZeroPacked", ReadError::bad_section, local_start, "padding behind the sources",
     [] { return with_stored(good, 8, 1, zstd_frame(Edit(stored_of(good, 8)).u8(28, 1).as_is())); }},

    {"LocalOfVersion3TooManySources", ReadError::bad_section, local_start_1_3,
     "2296 sources are over the limit of 2295",
     [] { return Edit(latest).u16(local_start_1_3, 2296).sealed(); }},
    {"LocalOfVersion3MasksTooNarrow", ReadError::bad_section, local_start_1_3 + 2,
     "masks of 32 bytes, must be of 48 for 259 sources",
     [] { return Edit(latest).u16(local_start_1_3 + 2, 32).sealed(); }},
    {"LocalOfVersion3WithPlainZstd", ReadError::bad_section, local_start_1_3,
     "of version 3 has the unknown codec 1",
     [] { return Edit(latest).u8(entry(7) + at::codec, 1).sealed(); }},

    {"NoLightGroups", ReadError::bad_section, groups_start, "0 groups, must be 1 to 8",
     [] { return Edit(latest).u16(groups_start, 0).sealed(); }},
    {"TooManyLightGroups", ReadError::bad_section, groups_start, "9 groups, must be 1 to 8",
     [] { return Edit(latest).u16(groups_start, 9).sealed(); }},
    {"LightGroupsReservedByte", ReadError::bad_section, groups_start + 2, "reserved",
     [] { return Edit(latest).u8(groups_start + 15, 1).sealed(); }},
    {"FewerLightGroupsThanBytes", ReadError::bad_section, groups_start,
     "has 294 bytes, must have 155 for 1 groups", [] { return Edit(latest).u16(groups_start, 1).sealed(); }},
    {"LightGroupWithoutName", ReadError::bad_section, groups_start + 80, "light group 1: its name",
     [] { return Edit(latest).u8(groups_start + 80, 0).sealed(); }},
    {"LightGroupNameWithoutEnd", ReadError::bad_section, groups_start + 16, "light group 0: its name",
     [] {
         Edit file(latest);
         for (std::size_t n = 0; n < 64; ++n)
             file.u8(groups_start + 16 + n, 'a');
         return file.sealed();
     }},
    {"LightGroupNameWithSomethingBehindIt", ReadError::bad_section, groups_start + 16,
     "light group 0: its name", [] { return Edit(latest).u8(groups_start + 79, 'a').sealed(); }},

    {"QualityTooManyGroups", ReadError::bad_section, quality_start + 8, "9 light groups are over",
     [] { return Edit(latest).u16(quality_start + 8, 9).sealed(); }},
    {"QualityReservedByte", ReadError::bad_section, quality_start + 10, "reserved",
     [] { return Edit(latest).u8(quality_start + 15, 1).sealed(); }},
    {"QualityOfFewerGroupsThanBytes", ReadError::bad_section, quality_start + 8,
     "has 112 bytes, must have 100 for 1 light groups",
     [] { return Edit(latest).u16(quality_start + 8, 1).sealed(); }},
    {"QualityErrorNotANumber", ReadError::bad_section, quality_start + 16 + 24 + 8, "not finite",
     [] { return Edit(latest).u32(quality_start + 16 + 24 + 8, nan_bits).sealed(); }},
    {"QualityUnknownFlag", ReadError::bad_section, quality_start + 16 + 20, "flags 8 are unknown",
     [] { return Edit(latest).u8(quality_start + 16 + 20, 8).sealed(); }},
    {"QualityReservedProbeByte", ReadError::bad_section, quality_start + 16 + 21, "reserved bytes",
     [] { return Edit(latest).u8(quality_start + 16 + 23, 1).sealed(); }},
    {"QualityGroupErrorInfinite", ReadError::bad_section, quality_start + 88 + 20, "not finite",
     [] { return Edit(latest).u32(quality_start + 88 + 20, infinity_bits).sealed(); }},

    {"ConvergenceTooShort", ReadError::bad_section, convergence_start,
     "convergence section (kind 9) has 47 bytes, must have 48",
     [] { return with_raw(9, cut(stored_of(good, 9))); }},
    {"ConvergenceUnknownCodec", ReadError::bad_section, convergence_start, "unknown codec 2",
     [] { return edit().u8(convergence_entry + at::codec, 2).sealed(); }},
    {"ErrorAskedNotANumber", ReadError::bad_section, convergence_start, "not finite",
     [] { return edit().u32(convergence_start, nan_bits).sealed(); }},
    {"GreatestErrorInfinite", ReadError::bad_section, convergence_start + 12, "not finite",
     [] { return edit().u32(convergence_start + 12, infinity_bits).sealed(); }},
};

class LightSectionReader : public testing::TestWithParam<Rejection> {};

TEST_P(LightSectionReader, IsRejected) {
    expect_rejected(GetParam());
}

INSTANTIATE_TEST_SUITE_P(, LightSectionReader, testing::ValuesIn(cases),
                         [](const auto& c) { return c.param.name; });

// What these kinds held in a file of version 1.0 is anything.
TEST(LightSectionVersions, FileOfVersion10WithTheirKindsIsReadAsBefore) {
    Bytes file = golden_bytes();
    for (std::uint16_t kind = 7; kind <= 10; ++kind)
        file = with_one_more(file, {kind, 1, 3, 5, {1, 2, 3}});
    Sector sector;
    const ReadStatus status = read_sector(file, sector);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(sector, golden_sector());
    EXPECT_TRUE(validate_sector(file).valid());
    EXPECT_FALSE(read_sector(Edit(file).u16(at::minor, 1).sealed(), sector).ok());
}

TEST(LightSectionVersions, SectionOfALaterVersionIsIgnored) {
    Sector expected = golden_sector_1_1();
    expected.local_transfer.reset();
    Sector sector;
    // Not even its codec or its length is looked at.
    const Bytes file = Edit(with_one_more(without(good, 8), {8, 2, 7, 9, {1, 2, 3}})).sealed();
    const ReadStatus status = read_sector(file, sector);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(sector, expected);
    EXPECT_TRUE(validate_sector(file).valid());
}

// What these kinds, and this version of local transfer, held before is anything.
TEST(LightSectionVersions, FileOfVersion12WithThoseOf13IsReadAsBefore) {
    Sector expected = golden_sector_1_3();
    expected.local_transfer.reset();
    expected.light_groups.clear();
    expected.quality.reset();
    Edit file(latest);
    for (const std::size_t start : {local_start_1_3, groups_start, quality_start})
        file.u8(start, 0xFF);
    Sector sector;
    const ReadStatus status = read_sector(file.u16(at::minor, 2).sealed(), sector);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(sector, expected);
    EXPECT_FALSE(read_sector(file.u16(at::minor, 3).sealed(), sector).ok());
}

TEST(LightSectionVersions, EachSectionStandsAlone) {
    for (const std::uint16_t kind : light_kinds) {
        Bytes file = good;
        for (const std::uint16_t other : light_kinds) {
            if (other != kind)
                file = without(file, other);
        }
        Sector sector;
        const ReadStatus status = read_sector(file, sector);
        EXPECT_TRUE(status.ok()) << status.message;
        EXPECT_EQ(sector.static_irradiance.empty(), kind != 7);
        EXPECT_EQ(sector.local_transfer.has_value(), kind == 8);
        EXPECT_EQ(sector.convergence.has_value(), kind == 9);
        EXPECT_EQ(write_sector(sector), file);
    }
}

TEST(LightSectionLimits, SectorWithoutProbesMayHaveLocalTransfer) {
    Sector sector = random_sector(1, 0), read;
    sector.local_transfer.emplace();
    const ReadStatus status = read_sector(write_sector(sector), read);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_EQ(read, sector);
}

TEST(LightSectionLimits, EveryPairOfTheLargestSectorIsRead) {
    Sector sector = random_sector(1, 255), read;
    LocalTransfer& local = sector.local_transfer.emplace();
    local.sources = neighbouring_sources(255);
    local.receivers.resize(255);
    std::vector<std::size_t> all;
    for (std::size_t s = 0; s < 255; ++s)
        all.push_back(s);
    for (std::size_t p = 0; p < 255; ++p)
        add_pairs(local, p, all, {});
    for (const Codec codec : {Codec::raw, Codec::zstd}) {
        const ReadStatus status = read_sector(write_sector(sector, {codec}), read);
        EXPECT_TRUE(status.ok()) << status.message;
        EXPECT_TRUE(read == sector);
    }
}

}  // namespace
}  // namespace drtv::test
