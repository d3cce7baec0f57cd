#include "settings/message/job_settings.h"

#include <gtest/gtest.h>

namespace drtv::settings {
namespace {

v1::Job job_of(const std::string& preset) {
    v1::Job job;
    job.mutable_settings()->set_preset(preset);
    return job;
}

TEST(SettingsMessage, EachSettingHasAFieldThatKnowsWhetherItIsSet) {
    for (const Setting& setting : table()) {
        const auto* message = is_of_bake(setting) ? v1::BakeSettings::descriptor() : v1::Job::descriptor();
        const auto* field = message->FindFieldByName(std::string(setting.name));
        ASSERT_NE(field, nullptr) << setting.name;
        EXPECT_TRUE(field->has_presence()) << setting.name;
    }
    EXPECT_EQ(v1::BakeSettings::descriptor()->field_count(),
              1 + std::ranges::count_if(table(), is_of_bake));  // and the preset
}

TEST(SettingsMessage, WhatIsNotSetIsThePresets) {
    EXPECT_EQ(read_settings(job_of("pc")).value(), preset("pc").value());
    v1::Job job = job_of("draft");
    job.mutable_settings()->set_rays(64);
    job.mutable_settings()->set_reach(0x1.99999ap+5f);
    job.mutable_settings()->set_lprt(true);
    job.set_tolerance(0);
    JobSettings expected = *preset("draft");
    expected.bake.rays = 64;
    expected.bake.reach_m = 0x1.99999ap+5f;
    expected.bake.local_transfer = true;
    expected.tolerance = 0;
    EXPECT_EQ(read_settings(job).value(), expected);
}

TEST(SettingsMessage, ComeBackAsTheyWere) {
    for (const Setting& setting : table()) {
        JobSettings settings = *preset("pc");
        assign(settings, setting, setting.max);
        v1::Job job = job_of("draft");
        write_settings(settings, job);
        EXPECT_EQ(read_settings(job).value(), settings) << setting.name;
    }
}

TEST(SettingsMessage, EveryFieldOutOfRangeIsRefused) {
    for (const Setting& setting : table()) {
        if (setting.max == 1 && is_integer(setting))
            continue;  // a bool cannot be
        v1::Job job = job_of("draft");
        set_field(job, setting, setting.max * 2);
        const auto read = read_settings(job);
        ASSERT_FALSE(read) << setting.name;
        EXPECT_TRUE(read.error().starts_with(std::string(setting.name) + " must be a number from "))
            << read.error();
    }
    v1::Job job = job_of("draft");
    job.mutable_settings()->set_reach(std::numeric_limits<float>::quiet_NaN());
    EXPECT_FALSE(read_settings(job));
    EXPECT_FALSE(read_settings(job_of("")));
}

// What they ask for would be left out without a word.
TEST(SettingsMessage, FieldsOfAnotherVersionAreRefused) {
    v1::Job job = job_of("draft");
    std::string bytes = job.settings().SerializeAsString();
    bytes += std::string("\x12\x02\x0a\x00", 4);  // field 2, which was a map of texts
    ASSERT_TRUE(job.mutable_settings()->ParseFromString(bytes));
    EXPECT_EQ(read_settings(job).error(),
              "the settings have fields of another version of bake: use the same for both");
}

}  // namespace
}  // namespace drtv::settings
