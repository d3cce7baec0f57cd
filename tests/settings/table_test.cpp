#include "settings/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace drtv::settings {
namespace {

const Setting& setting_of(std::string_view name) {
    const Setting* setting = find_setting(name);
    EXPECT_NE(setting, nullptr) << name;
    return *setting;
}

TEST(SettingsTable, TheStructsDefaultsAreThoseOfTheDefaultPreset) {
    EXPECT_EQ(preset(default_preset).value(), JobSettings{});
}

TEST(SettingsTable, PresetsAreThoseOfTheDesign) {
    EXPECT_EQ(preset("draft")->bake.rays, 256u);
    EXPECT_EQ(preset("console")->bake.rays, 2048u);
    EXPECT_EQ(preset("pc")->bake.rays, 4096u);
    EXPECT_FALSE(preset("console")->bake.local_transfer);
    EXPECT_TRUE(preset("pc")->bake.local_transfer);
    EXPECT_EQ(preset("draft")->bake.bounces, 3u);
    EXPECT_EQ(preset("ultra").error(), "the preset 'ultra' is unknown: there are draft, console, pc");
}

TEST(SettingsTable, EachSettingHasItsOwnNameAndMember) {
    std::set<std::string_view> names;
    for (const Setting& setting : table()) {
        EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
        EXPECT_EQ(std::ranges::count(table(), setting.member, &Setting::member), 1) << setting.name;
        EXPECT_LT(setting.min, setting.max);
        for (const double value : setting.defaults)
            EXPECT_TRUE(check(setting, value)) << setting.name << "=" << value;
    }
}

// A field that the table forgets would be in no key: results of other settings would pass for these.
TEST(SettingsTable, HoldsEveryField) {
    // One name more or less than there are fields does not compile.
    [[maybe_unused]] const auto [rays, bounces, reach_m, min_distance_m, error, local_transfer, local_bounces,
                                 local_rays] = BakeSettings{};
    [[maybe_unused]] const auto [bake, tolerance] = JobSettings{};
    EXPECT_EQ(table().size(), 8u + 1u);
}

TEST(SettingsTable, ValuesAreWrittenAndReadByTheirType) {
    for (const Setting& setting : table()) {
        for (const double value : {setting.min, setting.max}) {
            JobSettings settings;
            assign(settings, setting, value);
            EXPECT_EQ(value_of(settings, setting), value) << setting.name;
        }
    }
    EXPECT_EQ(parse(setting_of("reach"), "100.1").value(), static_cast<double>(100.1f));
    EXPECT_FALSE(std::signbit(parse(setting_of("error"), "-0").value()));
}

TEST(SettingsTable, ValuesOutOfRangeAreRefusedWithRangeAndValue) {
    for (const auto& [name, text] : {std::pair("rays", "15"),
                                     std::pair("rays", "65537"),
                                     std::pair("rays", "-1"),
                                     std::pair("rays", "1e3"),
                                     std::pair("rays", "64.5"),
                                     std::pair("rays", " 64"),
                                     std::pair("rays", "64x"),
                                     std::pair("bounces", "9"),
                                     std::pair("rays", "99999999999999999999"),
                                     std::pair("reach", "0.5"),
                                     std::pair("reach", "nan"),
                                     std::pair("reach", "inf"),
                                     std::pair("reach", "1e30"),
                                     std::pair("min_distance", "16.5"),
                                     std::pair("min_distance", ""),
                                     std::pair("lprt", "2"),
                                     std::pair("lprt_bounces", "5"),
                                     std::pair("error", "-0.1"),
                                     std::pair("reach", "12m"),
                                     std::pair("tolerance", "0.07")}) {
        const auto result = parse(setting_of(name), text);
        ASSERT_FALSE(result) << name << "=" << text;
        EXPECT_TRUE(result.error().starts_with(name)) << result.error();
        EXPECT_TRUE(result.error().ends_with("not '" + std::string(text) + "'")) << result.error();
    }
    EXPECT_EQ(parse(setting_of("rays"), "8").error(), "rays must be a number from 16 to 65536, not '8'");
    EXPECT_EQ(check(setting_of("tolerance"), 1).error(),
              "tolerance must be a number from 0 to 0.0625, not 1");
    EXPECT_FALSE(check(setting_of("bounces"), 1.5));
    EXPECT_FALSE(check(setting_of("reach"), std::nan("")));
}

TEST(SettingsTable, TheHelpHasALineForEach) {
    const std::string help = help_text();
    for (const Setting& setting : table()) {
        EXPECT_NE(help.find("\n" + std::string(setting.name) + " "), std::string::npos) << help;
        EXPECT_NE(help.find(setting.help), std::string::npos) << help;
    }
    EXPECT_EQ(std::ranges::count(help, '\n'), static_cast<std::ptrdiff_t>(table().size() + 1));
}

}  // namespace
}  // namespace drtv::settings
