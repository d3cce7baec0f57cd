#include <drtv/day.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace drtv {
namespace {

constexpr double day_hours = 24;
constexpr double noon = 12;
constexpr double degree = 0.017453292519943295;

double within_day(double hour) {
    if (!std::isfinite(hour))
        return 0;
    const double rest = std::fmod(hour, day_hours);
    return rest < 0 ? rest + day_hours : rest;
}

// Two keys and how far the hour is from the first to the second.
struct Between {
    std::size_t first;
    std::size_t second;
    float share;
};

// REQUIRES: there are keys.
template <class Key>
Between keys_around(std::span<const Key> keys, double hour) {
    const double at = within_day(hour);
    std::size_t second = 0;
    while (second < keys.size() && double{keys[second].hour} <= at)
        ++second;
    const std::size_t last = keys.size() - 1;
    const std::size_t first = second == 0 ? last : second - 1;
    second = second > last ? 0 : second;
    const double round = second <= first ? day_hours : 0;
    const double length = double{keys[second].hour} - double{keys[first].hour} + round;
    const double passed = within_day(at - double{keys[first].hour});
    const bool one_key = !(length > 0);
    return {first, second, one_key ? 0.0f : static_cast<float>(passed / length)};
}

float mix(float a, float b, float share) {
    return a + (b - a) * share;
}

Float3 direction_of(double east, double north, double up, double north_deg) {
    const double turn = north_deg * degree;
    const double x = east * std::cos(turn) + north * std::sin(turn);
    const double y = north * std::cos(turn) - east * std::sin(turn);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(up)};
}

constexpr std::array<ColourKey, 7> default_sun = {{{0, {0, 0, 0}},
                                                   {5.7f, {20, 5, 1}},
                                                   {6.5f, {90, 45, 18}},
                                                   {9, {150, 130, 105}},
                                                   {15, {150, 130, 105}},
                                                   {17.5f, {90, 45, 18}},
                                                   {18.3f, {20, 5, 1}}}};
constexpr std::array<ColourKey, 6> default_zenith = {{{4.8f, {0.004f, 0.008f, 0.020f}},
                                                      {5.7f, {0.30f, 0.45f, 0.90f}},
                                                      {8, {2.2f, 4.0f, 8.5f}},
                                                      {16, {2.2f, 4.0f, 8.5f}},
                                                      {18.3f, {0.30f, 0.45f, 0.90f}},
                                                      {19.2f, {0.004f, 0.008f, 0.020f}}}};
constexpr std::array<ColourKey, 6> default_horizon = {{{4.8f, {0.006f, 0.010f, 0.022f}},
                                                       {5.7f, {0.70f, 0.60f, 0.80f}},
                                                       {8, {6.5f, 8.0f, 10.0f}},
                                                       {16, {6.5f, 8.0f, 10.0f}},
                                                       {18.3f, {0.70f, 0.60f, 0.80f}},
                                                       {19.2f, {0.006f, 0.010f, 0.022f}}}};
constexpr std::array<ColourKey, 6> default_sun_side = {{{4.8f, {0, 0, 0}},
                                                        {5.7f, {3.0f, 1.2f, 0.3f}},
                                                        {8, {1.5f, 1.2f, 0.8f}},
                                                        {16, {1.5f, 1.2f, 0.8f}},
                                                        {18.3f, {3.0f, 1.2f, 0.3f}},
                                                        {19.2f, {0, 0, 0}}}};

}  // namespace

Day default_day() {
    Day day;
    day.sun = default_sun;
    day.zenith = default_zenith;
    day.horizon = default_horizon;
    day.sun_side = default_sun_side;
    return day;
}

Float3 sun_direction(const SunPath& path, double hour) {
    if (!path.keys.empty()) {
        const Between between = keys_around(path.keys, hour);
        const SunKey& first = path.keys[between.first];
        const SunKey& second = path.keys[between.second];
        constexpr float whole = 360;
        const float turn = std::remainder(second.azimuth_deg - first.azimuth_deg, whole);
        const double azimuth = double{first.azimuth_deg + turn * between.share} * degree;
        const double elevation =
            double{mix(first.elevation_deg, second.elevation_deg, between.share)} * degree;
        const double level = std::cos(elevation);
        return direction_of(level * std::sin(azimuth),
                            level * std::cos(azimuth),
                            std::sin(elevation),
                            double{path.north_deg});
    }
    const double latitude = double{path.latitude_deg} * degree;
    const double declination = double{path.declination_deg} * degree;
    const double hour_angle = (within_day(hour) - noon) * (360 / day_hours) * degree;
    const double east = -std::cos(declination) * std::sin(hour_angle);
    const double north = std::sin(declination) * std::cos(latitude) -
                         std::cos(declination) * std::cos(hour_angle) * std::sin(latitude);
    const double up = std::sin(declination) * std::sin(latitude) +
                      std::cos(declination) * std::cos(hour_angle) * std::cos(latitude);
    return direction_of(east, north, up, double{path.north_deg});
}

Float3 colour_at(std::span<const ColourKey> keys, double hour) {
    if (keys.empty())
        return {};
    const Between between = keys_around(keys, hour);
    Float3 colour;
    for (std::size_t c = 0; c < channel_count; ++c)
        colour[c] = mix(keys[between.first].colour[c], keys[between.second].colour[c], between.share);
    return colour;
}

SceneLight light_of_day(const Day& day, double hour, RelightMode mode, std::span<GroupColour> groups) {
    SceneLight light;
    light.mode = mode;
    light.sun = {colour_at(day.sun, hour), sun_direction(day.sun_path, hour)};
    const SkyColours sky{
        colour_at(day.zenith, hour), colour_at(day.horizon, hour), colour_at(day.sun_side, hour)};
    light.sky = gradient_sky(sky, light.sun.direction);
    const bool night = light.sun.direction[2] < 0;
    const Float3 burning = night ? Float3{1, 1, 1} : Float3{};
    light.other_groups = burning;
    for (std::size_t g = 0; g < day.groups.size(); ++g) {
        const GroupKeys& group = day.groups[g];
        groups[g] = {group.name, group.keys.empty() ? burning : colour_at(group.keys, hour)};
    }
    light.groups = groups.first(day.groups.size());
    return light;
}

}  // namespace drtv
