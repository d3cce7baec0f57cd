// Nothing is published that the validator rejects (docs/design.md, promise 3).
#include "bakerd/bake/sector_file.h"
#include "bakerd/bake/sector_bake.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <limits>

namespace drtv::test {
namespace {

Sector baked_sector() {
    GltfBuilder builder;
    builder.place(ground(200));
    settings::BakeSettings settings;
    settings.rays = 16;
    return bake::bake_sector(*open_world(builder), {0, 0}, settings).value().sector;
}

TEST(SectorFile, IsMadeOfWhatTheValidatorAccepts) {
    std::vector<std::string> warnings;
    const Sector sector = baked_sector();
    const auto file = bake::encode_sector(sector, warnings);
    ASSERT_TRUE(file) << file.error();
    EXPECT_TRUE(bake::decode_sector(*file));
    EXPECT_TRUE(warnings.empty());
}

TEST(SectorFile, IsNotMadeOfWhatTheValidatorRejects) {
    const auto refused = [](const Sector& sector) {
        std::vector<std::string> warnings;
        const auto file = bake::encode_sector(sector, warnings);
        return file ? "it was accepted" : file.error();
    };
    const Sector sound = baked_sector();
    Sector brighter = sound;  // than the sky
    for (auto& channel : brighter.probes[0].transfer) {
        for (auto& row : channel)
            row = {std::numeric_limits<std::int16_t>::max(), 0, 0, 0};
    }
    EXPECT_TRUE(refused(brighter).starts_with("sector (0, 0) does not pass validation: "))
        << refused(brighter);
    Sector dark = sound;
    dark.probes[0].sky_visibility[0] = -1;
    EXPECT_TRUE(refused(dark).starts_with("sector (0, 0) does not pass validation: ")) << refused(dark);
}

}  // namespace
}  // namespace drtv::test
