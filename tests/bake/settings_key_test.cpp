#include "bakerd/bake/settings_key.h"
#include "settings/table.h"

#include <gtest/gtest.h>

namespace drtv::bake {
namespace {

map::Digest key_of(const settings::JobSettings& settings) {
    return settings_key(settings.bake);
}

TEST(SettingsKey, ChangesWithEachSettingOfTheBake) {
    const settings::JobSettings base = *settings::preset("pc");
    for (const settings::Setting& setting : settings::table()) {
        settings::JobSettings other = base;
        const bool is_least = settings::value_of(base, setting) == setting.min;
        settings::assign(other, setting, is_least ? setting.max : setting.min);
        EXPECT_EQ(key_of(other) != key_of(base), settings::is_of_bake(setting)) << setting.name;
    }
}

TEST(SettingsKey, LeavesOutWhatLocalTransferAloneReads) {
    settings::JobSettings other = *settings::preset("console");
    other.bake.local_rays = 16;
    other.bake.local_bounces = 1;
    EXPECT_EQ(key_of(other), key_of(*settings::preset("console")));
}

// It is stored in files: a change of it bakes every map anew, and is made with baker_version alone.
TEST(SettingsKey, OfThePresetsStays) {
    ASSERT_EQ(baker_version, 6u);
    EXPECT_EQ(map::to_hex(key_of(*settings::preset("draft"))),
              "1bdb112a4cc39dba7a0f84077ac76a58c2a756334fa3838a580ed4bf3779a462");
    EXPECT_EQ(map::to_hex(key_of(*settings::preset("console"))),
              "4520cc453efa98cfb6e85905c86ca2fc8b3234ae81e84aa8e81402a672147ea4");
    EXPECT_EQ(map::to_hex(key_of(*settings::preset("pc"))),
              "797896c0766c0318d3171cb589a78bf860a61e2dbe3539e3055d2d8d3493c973");
    settings::JobSettings precise = *settings::preset("pc");
    precise.bake.error = 0.01f;
    precise.bake.local_rays = 512;
    EXPECT_EQ(map::to_hex(key_of(precise)),
              "75565b5eff8c6f2fd1fcef4ad97676583c37e8f963de377a385ab9896d75f20f");
}

}  // namespace
}  // namespace drtv::bake
