#include "bakerd/picture/hours.h"

#include <drtv/day_file.h>

#include <fmt/format.h>

#include <optional>

namespace drtv::picture {
namespace {

cli::Result<Hour> read_hour(const kit::LightRequest& request) {
    Hour hour;
    hour.time = request.time.value_or("");
    if (auto read = kit::read_light(request, "render", *hour.light); !read)
        return tl::unexpected(read.error());
    return hour;
}

// Gives the times of a sheet.
cli::Result<std::vector<std::optional<std::string>>> read_times(const RenderRequest& request) {
    for (const std::string& time : request.times) {
        double hours = 0;
        if (!parse_time(time, hours))
            return cli::fail(
                cli::exit_usage,
                fmt::format("render: --times takes times of a day such as 06:00,14:00, not \"{}\"", time));
    }
    return std::vector<std::optional<std::string>>(request.times.begin(), request.times.end());
}

bool is_dark(const kit::LightRequest& light) {
    return !light.time && !light.sun && !light.sun_direction && !light.sky && !light.sky_colours &&
           light.lights.empty() && light.groups.empty();
}

}  // namespace

cli::Result<Hours> read_hours(const RenderRequest& request) {
    kit::LightRequest light = request.light;
    if (is_dark(light))
        light.time = "12:00";
    auto times = read_times(request);
    if (!times)
        return tl::unexpected(times.error());
    if (times->empty())
        times->push_back(light.time);
    Hours hours;
    for (const std::optional<std::string>& time : *times) {
        light.time = time;
        auto hour = read_hour(light);
        if (!hour)
            return tl::unexpected(hour.error());
        hours.shown.push_back(std::move(*hour));
    }
    if (light.time)
        light.time = "12:00";
    auto noon = read_hour(light);
    if (!noon)
        return tl::unexpected(noon.error());
    hours.noon = std::move(*noon);
    return hours;
}

}  // namespace drtv::picture
