#include "scene_light.h"

#include "commands.h"
#include "files.h"
#include "number_list.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace drtv::tool {
namespace {

// False, and a complaint, where the option is given and is not `count` numbers; `numbers` stays empty where
// it is not given.
bool read_numbers(const std::optional<std::string>& text,
                  const char* option,
                  std::size_t count,
                  const char* form,
                  std::vector<double>& numbers) {
    if (!text)
        return true;
    const auto read = number_list(*text, count);
    if (!read) {
        complain(std::string("relight: ") + option + " takes " + form + ", not \"" + *text + "\"");
        return false;
    }
    numbers = *read;
    return true;
}

bool none_below_zero(const std::vector<double>& numbers, const char* option) {
    const auto low = std::find_if(numbers.begin(), numbers.end(), [](double n) { return n < 0; });
    if (low == numbers.end())
        return true;
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", *low);
    complain(std::string("relight: ") + option + " takes light of at least 0, not " + text.data());
    return false;
}

bool read_sun_and_sky(const LightRequest& request, SceneLight& light) {
    std::vector<double> sun, direction, sky, colours;
    const bool read =
        read_numbers(request.sun, "--sun", 3, "r,g,b", sun) &&
        read_numbers(request.sun_direction, "--sun-direction", 3, "x,y,z", direction) &&
        read_numbers(request.sky, "--sky", 3, "r,g,b", sky) &&
        read_numbers(
            request.sky_colours, "--sky-colours", 9, "nine numbers (zenith, horizon, sun side)", colours);
    if (!read || !none_below_zero(sun, "--sun") || !none_below_zero(sky, "--sky") ||
        !none_below_zero(colours, "--sky-colours"))
        return false;
    Float3 to_sun{};
    if (!direction.empty()) {
        to_sun = float3_of(direction.data());
        if (to_sun == Float3{}) {
            complain("relight: --sun-direction has no length");
            return false;
        }
    }
    if (!sun.empty())
        light.sun = {float3_of(sun.data()), to_sun};
    if (!sky.empty())
        light.sky = constant_sky(float3_of(sky.data()));
    if (!colours.empty()) {
        const double* numbers = colours.data();
        light.sky =
            gradient_sky({float3_of(numbers), float3_of(numbers + 3), float3_of(numbers + 6)}, to_sun);
    }
    return true;
}

// The day at its time. Gives the exit code.
int read_day(const LightRequest& request, RequestedLight& to) {
    double hours = 0;
    if (!parse_time(*request.time, hours)) {
        complain("relight: --time takes a time of day such as 14:00, not \"" + *request.time + "\"");
        return exit_usage;
    }
    if (request.gradients) {
        const TextRead file = read_text(*request.gradients);
        if (!file.error.empty()) {
            complain(file.error);
            return exit_unreadable;
        }
        if (const std::string error = DayFile::read(file.text, to.day); !error.empty()) {
            complain(*request.gradients + ": " + error);
            return exit_invalid;
        }
    }
    const Day& day = to.day.day();
    to.groups.resize(day.groups.size());
    to.light = light_of_day(day, hours, to.light.mode, to.groups);
    return exit_valid;
}

bool read_lamps(const LightRequest& request, std::vector<PointLight>& lamps) {
    for (const std::string& text : request.lights) {
        std::vector<double> numbers;
        if (!read_numbers(text, "--light", 6, "x,y,z,r,g,b", numbers))
            return false;
        const std::vector<double> colour(numbers.begin() + 3, numbers.end());
        if (!none_below_zero(colour, "--light"))
            return false;
        lamps.push_back({{numbers[0], numbers[1], numbers[2]}, float3_of(colour.data())});
    }
    return true;
}

bool read_groups(const LightRequest& request, RequestedLight& to) {
    for (const std::string& text : request.groups) {
        const std::size_t equals = text.rfind('=');
        const auto numbers =
            equals == std::string::npos ? std::nullopt : number_list(text.substr(equals + 1), 3);
        if (!numbers || equals == 0) {
            complain("relight: --group takes NAME=r,g,b, not \"" + text + "\"");
            return false;
        }
        if (!none_below_zero(*numbers, "--group"))
            return false;
        to.names.push_back(text.substr(0, equals));
        to.groups.push_back({to.names.back(), float3_of(numbers->data())});
    }
    to.light.groups = to.groups;
    return true;
}

}  // namespace

int read_light(const LightRequest& request, RequestedLight& light) {
    light.light.mode = request.mode == "literal" ? RelightMode::literal : RelightMode::accurate;
    if (request.time) {
        if (const int exit_code = read_day(request, light); exit_code != exit_valid)
            return exit_code;
    }
    const bool read = (request.time || read_sun_and_sky(request, light.light)) &&
                      read_lamps(request, light.lamps) && read_groups(request, light);
    return read ? exit_valid : exit_usage;
}

}  // namespace drtv::tool
