#include "bakerd/bake/settings.h"

#include <gtest/gtest.h>

namespace drtv::bake {
namespace {

TEST(Settings, PresetsAreThoseOfTheDesign) {
    EXPECT_EQ(preset("console")->rays, 2048u);
    EXPECT_EQ(preset("pc")->rays, 4096u);
    EXPECT_FALSE(preset("console")->local_transfer);
    EXPECT_TRUE(preset("pc")->local_transfer);
    EXPECT_EQ(preset("draft")->rays, 256u);
    EXPECT_EQ(preset("draft")->bounces, 3u);
    EXPECT_NE(preset("ultra").error().find("'ultra'"), std::string::npos);
}

TEST(Settings, ValuesOutOfRangeAreRefusedAndChangeNothing) {
    Settings settings;
    const Settings before = settings;
    for (const auto& [key, value] :
         {std::pair("rays", "15"), std::pair("rays", "65537"), std::pair("rays", "-1"),
          std::pair("rays", "1e3"), std::pair("bounces", "9"), std::pair("reach", "0.5"),
          std::pair("reach", "nan"), std::pair("reach", "inf"), std::pair("min_distance", "16.5"),
          std::pair("min_distance", ""), std::pair("lprt", "2"), std::pair("lprt_bounces", "5"),
          std::pair("error", "-0.1"), std::pair("reach", "12m")}) {
        const auto result = set(settings, key, value);
        ASSERT_FALSE(result) << key << "=" << value;
        EXPECT_NE(result.error().find(key), std::string::npos);
        EXPECT_EQ(settings, before);
    }
}

TEST(Settings, KeyChangesWithEachSetting) {
    const Settings base;
    for (const auto& [key, value] :
         {std::pair("rays", "1024"), std::pair("bounces", "2"), std::pair("reach", "100.5"),
          std::pair("min_distance", "7"), std::pair("error", "0.01"), std::pair("lprt", "1")}) {
        Settings other;
        ASSERT_TRUE(set(other, key, value));
        EXPECT_NE(settings_key(other), settings_key(base)) << key;
    }
    EXPECT_EQ(settings_key(Settings{}), settings_key(base));
}

// It is stored in files: a change of it bakes every map anew, and is made with baker_version alone.
TEST(Settings, KeysOfThePresetsStay) {
    ASSERT_EQ(baker_version, 6u);
    EXPECT_EQ(map::to_hex(settings_key(*preset("draft"))),
              "1bdb112a4cc39dba7a0f84077ac76a58c2a756334fa3838a580ed4bf3779a462");
    EXPECT_EQ(map::to_hex(settings_key(*preset("console"))),
              "4520cc453efa98cfb6e85905c86ca2fc8b3234ae81e84aa8e81402a672147ea4");
    EXPECT_EQ(map::to_hex(settings_key(*preset("pc"))),
              "797896c0766c0318d3171cb589a78bf860a61e2dbe3539e3055d2d8d3493c973");
    Settings precise = *preset("pc");
    precise.error = 0.01f;
    precise.local_rays = 512;
    EXPECT_EQ(map::to_hex(settings_key(precise)),
              "75565b5eff8c6f2fd1fcef4ad97676583c37e8f963de377a385ab9896d75f20f");
}

}  // namespace
}  // namespace drtv::bake
