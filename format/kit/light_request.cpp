#include "light_request.h"

#include "cli/number_list.h"
#include "files.h"
#include "folder/whole_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace drtv::kit {
namespace {

class Reader {
  public:
    Reader(const LightRequest& request, const std::string& command) : request_(request), command_(command) {}

    cli::Result<void> read(RequestedLight& to) const {
        if (request_.gradients && !request_.time)
            return refuse("--gradients goes with --time");
        to.light.mode = request_.mode == "literal" ? RelightMode::literal : RelightMode::accurate;
        auto read = request_.time ? read_day(to) : read_sun_and_sky(to.light);
        return read.and_then([&] { return read_lamps(to.lamps); }).and_then([&] { return read_groups(to); });
    }

  private:
    using Read = cli::Result<void>;
    using Numbers = std::vector<double>;

    tl::unexpected<cli::Failure> refuse(const std::string& sentence) const {
        return cli::fail(cli::exit_usage, command_ + ": " + sentence);
    }

    // None where the option is not given.
    cli::Result<Numbers> read_numbers(const std::optional<std::string>& text,
                                      const char* option,
                                      std::size_t count,
                                      const char* form) const {
        if (!text)
            return Numbers();
        const auto read = cli::number_list(*text, count);
        if (!read)
            return refuse(std::string(option) + " takes " + form + ", not \"" + *text + "\"");
        return *read;
    }

    Read none_below_zero(const Numbers& numbers, const char* option) const {
        const auto low = std::find_if(numbers.begin(), numbers.end(), [](double n) { return n < 0; });
        if (low == numbers.end())
            return {};
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%g", *low);
        return refuse(std::string(option) + " takes light of at least 0, not " + text.data());
    }

    // Numbers of light.
    cli::Result<Numbers> read_light(const std::optional<std::string>& text,
                                    const char* option,
                                    std::size_t count,
                                    const char* form) const {
        auto numbers = read_numbers(text, option, count, form);
        if (numbers) {
            if (auto checked = none_below_zero(*numbers, option); !checked)
                return tl::unexpected(checked.error());
        }
        return numbers;
    }

    Read read_sun_and_sky(SceneLight& light) const {
        const auto sun = read_light(request_.sun, "--sun", 3, "r,g,b");
        if (!sun)
            return tl::unexpected(sun.error());
        const auto direction = read_numbers(request_.sun_direction, "--sun-direction", 3, "x,y,z");
        if (!direction)
            return tl::unexpected(direction.error());
        const auto sky = read_light(request_.sky, "--sky", 3, "r,g,b");
        if (!sky)
            return tl::unexpected(sky.error());
        const auto colours =
            read_light(request_.sky_colours, "--sky-colours", 9, "nine numbers (zenith, horizon, sun side)");
        if (!colours)
            return tl::unexpected(colours.error());
        Float3 to_sun{};
        if (!direction->empty()) {
            to_sun = cli::float3_of(direction->data());
            if (to_sun == Float3{})
                return refuse("--sun-direction has no length");
        }
        if (!sun->empty())
            light.sun = {cli::float3_of(sun->data()), to_sun};
        if (!sky->empty())
            light.sky = constant_sky(cli::float3_of(sky->data()));
        if (!colours->empty()) {
            const double* numbers = colours->data();
            light.sky = gradient_sky(
                {cli::float3_of(numbers), cli::float3_of(numbers + 3), cli::float3_of(numbers + 6)}, to_sun);
        }
        return {};
    }

    // The day at its time.
    Read read_day(RequestedLight& to) const {
        double hours = 0;
        if (!parse_time(*request_.time, hours))
            return refuse("--time takes a time of day such as 14:00, not \"" + *request_.time + "\"");
        if (request_.gradients) {
            const auto text = folder::read_whole(*request_.gradients);
            if (!text)
                return tl::unexpected(text.error());
            auto day = DayFile::read(*text);
            if (!day)
                return cli::fail(cli::exit_invalid, *request_.gradients + ": " + day.error());
            to.day = std::move(*day);
        }
        const Day& day = to.day.day();
        to.groups.resize(day.groups.size());
        to.light = light_of_day(day, hours, to.light.mode, to.groups);
        return {};
    }

    Read read_lamps(std::vector<PointLight>& lamps) const {
        for (const std::string& text : request_.lights) {
            const auto numbers = read_numbers(text, "--light", 6, "x,y,z,r,g,b");
            if (!numbers)
                return tl::unexpected(numbers.error());
            const Numbers colour(numbers->begin() + 3, numbers->end());
            if (auto checked = none_below_zero(colour, "--light"); !checked)
                return checked;
            lamps.push_back({{(*numbers)[0], (*numbers)[1], (*numbers)[2]}, cli::float3_of(colour.data())});
        }
        return {};
    }

    Read read_groups(RequestedLight& to) const {
        for (const std::string& text : request_.groups) {
            const std::size_t equals = text.rfind('=');
            const auto numbers =
                equals == std::string::npos ? std::nullopt : cli::number_list(text.substr(equals + 1), 3);
            if (!numbers || equals == 0)
                return refuse("--group takes NAME=r,g,b, not \"" + text + "\"");
            if (auto checked = none_below_zero(*numbers, "--group"); !checked)
                return checked;
            to.names.push_back(text.substr(0, equals));
            to.groups.push_back({to.names.back(), cli::float3_of(numbers->data())});
        }
        to.light.groups = to.groups;
        return {};
    }

    const LightRequest& request_;
    const std::string& command_;
};

}  // namespace

cli::Result<void> read_light(const LightRequest& request, const std::string& command, RequestedLight& light) {
    return Reader(request, command).read(light);
}

}  // namespace drtv::kit
