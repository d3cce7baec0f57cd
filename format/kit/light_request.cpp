#include "light_request.h"

#include "exit_code.h"
#include "files.h"
#include "number_list.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace drtv::kit {
namespace {

class Reader {
  public:
    Reader(const LightRequest& request, const std::string& command) : request_(request), command_(command) {}

    // Gives the exit code.
    int read(RequestedLight& to) const {
        if (request_.gradients && !request_.time) {
            refuse("--gradients goes with --time");
            return exit_usage;
        }
        to.light.mode = request_.mode == "literal" ? RelightMode::literal : RelightMode::accurate;
        if (request_.time) {
            if (const int exit_code = read_day(to); exit_code != exit_valid)
                return exit_code;
        }
        const bool read =
            (request_.time || read_sun_and_sky(to.light)) && read_lamps(to.lamps) && read_groups(to);
        return read ? exit_valid : exit_usage;
    }

  private:
    bool refuse(const std::string& sentence) const {
        complain(command_ + ": " + sentence);
        return false;
    }

    // False, and a complaint, where the option is given and is not `count` numbers; `numbers` stays empty
    // where it is not given.
    bool read_numbers(const std::optional<std::string>& text,
                      const char* option,
                      std::size_t count,
                      const char* form,
                      std::vector<double>& numbers) const {
        if (!text)
            return true;
        const auto read = number_list(*text, count);
        if (!read)
            return refuse(std::string(option) + " takes " + form + ", not \"" + *text + "\"");
        numbers = *read;
        return true;
    }

    bool none_below_zero(const std::vector<double>& numbers, const char* option) const {
        const auto low = std::find_if(numbers.begin(), numbers.end(), [](double n) { return n < 0; });
        if (low == numbers.end())
            return true;
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%g", *low);
        return refuse(std::string(option) + " takes light of at least 0, not " + text.data());
    }

    bool read_sun_and_sky(SceneLight& light) const {
        std::vector<double> sun, direction, sky, colours;
        const bool read = read_numbers(request_.sun, "--sun", 3, "r,g,b", sun) &&
                          read_numbers(request_.sun_direction, "--sun-direction", 3, "x,y,z", direction) &&
                          read_numbers(request_.sky, "--sky", 3, "r,g,b", sky) &&
                          read_numbers(request_.sky_colours,
                                       "--sky-colours",
                                       9,
                                       "nine numbers (zenith, horizon, sun side)",
                                       colours);
        if (!read || !none_below_zero(sun, "--sun") || !none_below_zero(sky, "--sky") ||
            !none_below_zero(colours, "--sky-colours"))
            return false;
        Float3 to_sun{};
        if (!direction.empty()) {
            to_sun = float3_of(direction.data());
            if (to_sun == Float3{})
                return refuse("--sun-direction has no length");
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
    int read_day(RequestedLight& to) const {
        double hours = 0;
        if (!parse_time(*request_.time, hours)) {
            refuse("--time takes a time of day such as 14:00, not \"" + *request_.time + "\"");
            return exit_usage;
        }
        if (request_.gradients) {
            const TextRead file = read_text(*request_.gradients);
            if (!file.error.empty()) {
                complain(file.error);
                return exit_unreadable;
            }
            if (const std::string error = DayFile::read(file.text, to.day); !error.empty()) {
                complain(*request_.gradients + ": " + error);
                return exit_invalid;
            }
        }
        const Day& day = to.day.day();
        to.groups.resize(day.groups.size());
        to.light = light_of_day(day, hours, to.light.mode, to.groups);
        return exit_valid;
    }

    bool read_lamps(std::vector<PointLight>& lamps) const {
        for (const std::string& text : request_.lights) {
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

    bool read_groups(RequestedLight& to) const {
        for (const std::string& text : request_.groups) {
            const std::size_t equals = text.rfind('=');
            const auto numbers =
                equals == std::string::npos ? std::nullopt : number_list(text.substr(equals + 1), 3);
            if (!numbers || equals == 0)
                return refuse("--group takes NAME=r,g,b, not \"" + text + "\"");
            if (!none_below_zero(*numbers, "--group"))
                return false;
            to.names.push_back(text.substr(0, equals));
            to.groups.push_back({to.names.back(), float3_of(numbers->data())});
        }
        to.light.groups = to.groups;
        return true;
    }

    const LightRequest& request_;
    const std::string& command_;
};

}  // namespace

int read_light(const LightRequest& request, const std::string& command, RequestedLight& light) {
    return Reader(request, command).read(light);
}

}  // namespace drtv::kit
