// A day's light: the sun's path, keys, and the file that tools read.
#include <drtv/day.h>
#include <drtv/day_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace drtv {
namespace {

void expect_near(const Float3& found, const Float3& expected, double tolerance = 1e-5) {
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << c;
}

TEST(SunPath, OnTheEquatorAtEquinoxItGoesOverhead) {
    const SunPath path{.latitude_deg = 0, .declination_deg = 0, .north_deg = 0, .keys = {}};
    expect_near(sun_direction(path, 6), {1, 0, 0});
    expect_near(sun_direction(path, 12), {0, 0, 1});
    expect_near(sun_direction(path, 18), {-1, 0, 0});
    expect_near(sun_direction(path, 0), {0, 0, -1});
    expect_near(sun_direction(path, 36), {0, 0, 1});
    expect_near(sun_direction(path, NAN), {0, 0, -1});
}

TEST(SunPath, NoonIsInTheSouthAtTheHeightOfTheYear) {
    const SunPath path{.latitude_deg = 50, .declination_deg = 20, .north_deg = 0, .keys = {}};
    const float elevation = (90 - 50 + 20) * 0.01745329252f;
    expect_near(sun_direction(path, 12), {0, -std::cos(elevation), std::sin(elevation)});
    const SunPath turned{.latitude_deg = 50, .declination_deg = 20, .north_deg = 90, .keys = {}};
    expect_near(sun_direction(turned, 12), {-std::cos(elevation), 0, std::sin(elevation)});
    // It rises in the east, north of it in summer.
    const Float3 morning = sun_direction(path, 6);
    EXPECT_GT(morning[0], 0);
    EXPECT_GT(morning[1], 0);
    EXPECT_NEAR(std::hypot(morning[0], morning[1], morning[2]), 1, 1e-6);
}

TEST(SunPath, KeysGoTheShorterWayRoundNorth) {
    const SunKey keys[] = {{6, 350, 0}, {12, 30, 40}};
    const SunPath path{.keys = keys};
    const float azimuth = 10 * 0.01745329252f, elevation = 20 * 0.01745329252f;
    expect_near(sun_direction(path, 9), {std::sin(azimuth) * std::cos(elevation),
                                         std::cos(azimuth) * std::cos(elevation), std::sin(elevation)});
}

TEST(ColourKeys, AreLinearBetweenAndGoRoundMidnight) {
    const ColourKey keys[] = {{6, {1, 0, 0}}, {10, {3, 4, 0}}, {22, {0, 0, 8}}};
    expect_near(colour_at(keys, 6), {1, 0, 0});
    expect_near(colour_at(keys, 7), {1.5f, 1, 0});
    expect_near(colour_at(keys, 16), {1.5f, 2, 4});
    expect_near(colour_at(keys, 0), {0.25f, 0, 6});
    expect_near(colour_at(keys, 24), {0.25f, 0, 6});
    expect_near(colour_at(keys, -2), {0, 0, 8});
    expect_near(colour_at(keys, 5.999999), {1, 0, 0});
    const ColourKey one[] = {{13, {1, 2, 3}}};
    expect_near(colour_at(one, 2), {1, 2, 3});
    EXPECT_EQ(colour_at({}, 12), Float3{});
    const ColourKey whole[] = {{0, {1, 1, 1}}, {24, {3, 3, 3}}};
    expect_near(colour_at(whole, 12), {2, 2, 2});
}

TEST(LightOfDay, TheDefaultDayIsBrightAtNoonAndBlueAtNight) {
    const SceneLight noon = light_of_day(default_day(), 12, RelightMode::accurate, {});
    EXPECT_NEAR(noon.sun.irradiance[0], 150, 1);
    EXPECT_GT(noon.sun.direction[2], 0.95f);
    EXPECT_EQ(noon.other_groups, Float3{});
    const SceneLight night = light_of_day(default_day(), 0, RelightMode::accurate, {});
    EXPECT_LT(night.sun.direction[2], 0);
    EXPECT_EQ(night.other_groups, (Float3{1, 1, 1}));
    EXPECT_GT(night.sky[2][0], 2 * night.sky[0][0]);
    EXPECT_GT(night.sky[0][0], 0);
    for (double hour = 0; hour < 24; hour += 0.1) {
        const SceneLight light = light_of_day(default_day(), hour, RelightMode::accurate, {});
        if (light.sun.direction[2] > 0.01f) {
            EXPECT_GT(light.sun.irradiance[0], 0) << hour;
        }
    }
}

constexpr const char* good = R"({
    "sun_path": {"latitude": 30, "declination": -10, "north": 90},
    "sun": [{"time": "06:00", "colour": [1, 2, 3]}, {"time": "18:30", "colour": [5, 6, 7]}],
    "zenith": [{"time": "12:00", "colour": [1, 1, 2]}],
    "horizon": [{"time": "12:00", "colour": [2, 2, 2]}],
    "sun_side": [],
    "groups": {"lanterns": [], "neon": [{"time": "20:00", "colour": [4, 0, 0]}]}})";

TEST(DayFile, IsReadIntoADay) {
    DayFile file = DayFile::read(good).value();
    const Day& day = file.day();
    EXPECT_EQ(day.sun_path.latitude_deg, 30);
    ASSERT_EQ(day.sun.size(), 2u);
    EXPECT_EQ(day.sun[1].hour, 18.5f);
    EXPECT_EQ(day.sun[1].colour, (Float3{5, 6, 7}));
    std::vector<GroupColour> groups(day.groups.size());
    const SceneLight night = light_of_day(day, 1, RelightMode::literal, groups);
    ASSERT_EQ(night.groups.size(), 2u);
    EXPECT_EQ(night.groups[0].name, "lanterns");
    EXPECT_EQ(night.groups[0].colour, (Float3{1, 1, 1}));
    EXPECT_EQ(night.groups[1].colour, (Float3{4, 0, 0}));
    const SceneLight noon = light_of_day(day, 12, RelightMode::literal, groups);
    EXPECT_EQ(noon.groups[0].colour, Float3{});
    EXPECT_EQ(noon.groups[1].colour, (Float3{4, 0, 0}));
    const DayFile copy = file;
    file = DayFile();
    EXPECT_EQ(copy.day().sun[0].colour, (Float3{1, 2, 3}));
}

std::string replaced(const std::string& what, const std::string& with) {
    std::string text = good;
    text.replace(text.find(what), what.size(), with);
    return text;
}

TEST(DayFile, SaysWhatIsWrongWhereAndWithWhichValue) {
    struct Case {
        std::string text;
        std::string sentence;
    };
    const std::vector<Case> cases = {
        {"", "it is no JSON: "},
        {"[1, 2]", "the light is [1,2]: it must be an object"},
        {replaced(R"("18:30")", R"("25:00")"),
         R"(sun[1].time is "25:00": it must be a time of day such as "06:00")"},
        {replaced(R"("18:30")", "18"), R"(sun[1].time is 18: it must be a time of day such as "06:00")"},
        {replaced(R"("18:30")", R"("05:00")"), R"(sun[1].time is "05:00": times must rise from key to key)"},
        {replaced("[5, 6, 7]", "[5, 6]"), "sun[1].colour is [5,6]: it must be three numbers, [r, g, b]"},
        {replaced("[5, 6, 7]", "[5, -6, 7]"),
         "sun[1].colour[1] is -6: it must be a number from 0 to 1000000"},
        {replaced("[5, 6, 7]", "[5, null, 7]"),
         "sun[1].colour[1] is null: it must be a number from 0 to 1000000"},
        {replaced(R"("zenith")", R"("zenit")"),
         R"("zenit" in the light is unknown: there are $schema, sun_path, sun, zenith, horizon, sun_side, groups)"},
        {R"({"sun": []})", R"(the light has no "zenith")"},
        {replaced(R"("latitude": 30, )", ""), R"(sun_path has no "latitude")"},
        {replaced(R"("latitude": 30)", R"("latitude": 91)"),
         "sun_path.latitude is 91: it must be a number from -90 to 90"},
        {replaced(R"("north": 90)", R"("keys": [])"),
         R"(sun_path has "keys" and also "latitude" or "declination": take one way)"},
        {replaced(R"("neon": [{"time": "20:00", "colour": [4, 0, 0]}])", R"("neon": [4])"),
         "groups.\"neon\"[0] is 4: it must be an object"}};
    for (const auto& [text, sentence] : cases) {
        const auto file = DayFile::read(text);
        ASSERT_FALSE(file) << text;
        EXPECT_EQ(file.error().substr(0, sentence.size()), sentence);
        EXPECT_EQ(file.error().find('\n'), std::string::npos);
    }
}

TEST(ParseTime, TakesHoursAndMinutesOfADay) {
    double hours = -1;
    EXPECT_TRUE(parse_time("14:30", hours));
    EXPECT_EQ(hours, 14.5);
    EXPECT_TRUE(parse_time("6:06:36", hours));
    EXPECT_NEAR(hours, 6.11, 1e-12);
    EXPECT_TRUE(parse_time("24:00", hours));
    for (const char* wrong : {"", "14", "14:", ":30", "14:60", "24:01", "-1:00", "14:30:61", "1:2:3:4",
                              "14h30", "014:00", " 14:00"})
        EXPECT_FALSE(parse_time(wrong, hours)) << wrong;
}

}  // namespace
}  // namespace drtv
