// The light of a moment as arguments say it: the same options for every command that relights.
#pragma once

#include "cli/failure.h"

#include <drtv/day_file.h>

#include <drtv/light.h>
#include <drtv/local_lights.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace drtv::kit {

// As on the command line. What is not given is dark, but static light, which is 1.
struct LightRequest {
    std::optional<std::string> time;           // "14:00": sun, sky and groups from gradients
    std::optional<std::string> gradients;      // a file; the built-in day without it
    std::optional<std::string> sun;            // r,g,b: irradiance on a surface that faces it
    std::optional<std::string> sun_direction;  // x,y,z towards it
    std::optional<std::string> sky;            // r,g,b: one radiance
    std::optional<std::string> sky_colours;    // zenith, horizon, sun side: nine numbers
    std::vector<std::string> lights;           // x,y,z,r,g,b: flux / (4 pi)
    std::vector<std::string> groups;           // NAME=r,g,b
    std::string mode = "accurate";             // or literal
};

// Not to be moved: the light points into it.
struct RequestedLight {
    SceneLight light;
    std::vector<PointLight> lamps;
    DayFile day;
    std::vector<GroupColour> groups;
    std::deque<std::string> names;  // whose texts stay where they are

    RequestedLight() = default;
    RequestedLight(const RequestedLight&) = delete;
    RequestedLight& operator=(const RequestedLight&) = delete;
};

// Fails, in the name of the command, where an argument or the file is wrong.
[[nodiscard]] cli::Result<void> read_light(const LightRequest& request,
                                           const std::string& command,
                                           RequestedLight& light);

}  // namespace drtv::kit
