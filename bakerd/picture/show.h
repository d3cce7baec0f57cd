// What a picture shows.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::picture {

enum class Show : std::uint8_t {
    all,  // the scene as a game would show it
    // Of the ambient light of white surfaces: all, and by part (drtv::AmbientParts).
    ambient,
    sky_direct,
    sky_bounce,
    sun_bounce,
    static_light,
    local,
    // What the runtime does, by colours.
    fallback,
    tile,
    cells,
    leaks,
    probes,
    weights,
    age,
    clipped
};

struct ShowName {
    Show show;
    std::string_view name;
};
[[nodiscard]] const std::vector<ShowName>& show_names();
[[nodiscard]] std::string_view name_of(Show show);
// REQUIRES: a name of the table.
[[nodiscard]] Show show_of(std::string_view name);

// Whether it is light of the surfaces themselves: all, or of the ambient light.
[[nodiscard]] inline bool is_surface_light(Show show) {
    return show <= Show::local;
}
// Whether it is light, which is exposed and developed; else colours are shown as they are.
[[nodiscard]] inline bool is_light(Show show) {
    return is_surface_light(show) || show == Show::probes;
}

}  // namespace drtv::picture
