// Sun and sky over a day, from an artist's gradients (slide 25 of the talk, see drtv/light.h). Fill the plain
// structs as you like; the tools read them from JSON (format/light.schema.json).
//
// Hours are 0 to 24 and wrap around: 25 is 1. Colours are linear between two keys, and across midnight from
// the last key to the first; a single key holds all day. Without keys a colour is 0. Keys must be sorted by
// hour.
//
//     const drtv::ColourKey sun[] = {{6, {200, 90, 30}}, {12, {150, 145, 135}}, {18, {200, 90, 30}}};
//     drtv::Day day = drtv::default_day();
//     day.sun = sun;
//     const drtv::SceneLight light = drtv::light_of_day(day, 14.5, drtv::RelightMode::accurate, storage);
#pragma once

#include <drtv/light.h>

#include <span>
#include <string_view>

namespace drtv {

struct ColourKey {
    float hour = 0;
    Float3 colour{};
};

struct SunKey {
    float hour = 0;
    float azimuth_deg = 0;    // clockwise from north, seen from above; between keys the shorter way round
    float elevation_deg = 0;  // above the horizon
};

// Where the sun stands. Without keys it is in the south at 12 hours (in the north where the latitude is below
// the declination), as on Earth in true solar time. With keys it follows them.
struct SunPath {
    float latitude_deg = 18;
    float declination_deg = 10;
    float north_deg = 0;  // where north is, clockwise from the world's +y; with 0, east is +x
    std::span<const SunKey> keys;
};

struct GroupKeys {
    std::string_view name;  // of a light group
    std::span<const ColourKey> keys;
};

struct Day {
    SunPath sun_path;
    std::span<const ColourKey> sun;     // irradiance on a surface that faces it, W/m2
    std::span<const ColourKey> zenith;  // radiance, W/(sr m2); gradient_sky makes a sky of the three
    std::span<const ColourKey> horizon;
    std::span<const ColourKey> sun_side;
    // A light group without keys, or not named here, has the colour 1 while the sun is below the horizon,
    // else 0.
    std::span<const GroupKeys> groups;
};

// A clear day near the equator: 100,000 lux from the sun at noon, at 683 lm/W, and a dim blue night.
[[nodiscard]] Day default_day();

// Unit vector towards the sun, below the horizon too. An hour that is not finite counts as 0.
[[nodiscard]] Float3 sun_direction(const SunPath& path, double hour);

[[nodiscard]] Float3 colour_at(std::span<const ColourKey> keys, double hour);

// The light at `hour`. Its groups are written to `groups`, which must outlive it: REQUIRES room for
// day.groups.size().
[[nodiscard]] SceneLight light_of_day(const Day& day,
                                      double hour,
                                      RelightMode mode,
                                      std::span<GroupColour> groups);

}  // namespace drtv
