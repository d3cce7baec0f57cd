#include "bakerd/picture/view_arguments.h"

#include "format/cli/number_list.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace drtv::picture {
namespace {

constexpr std::size_t max_side = 16384;  // pixels

constexpr float min_look_m = 0.001f;
constexpr double min_side_m = 1;

bool are_in_world(const std::vector<double>& metres) {
    constexpr double farthest_m = 2e6;
    return std::ranges::all_of(metres, [](double n) { return std::abs(n) <= farthest_m; });
}

cli::Result<glm::vec3> read_place(const std::string& text, const char* option) {
    const auto numbers = cli::number_list(text, 3);
    if (!numbers || !are_in_world(*numbers))
        return cli::fail(cli::exit_usage,
                         fmt::format("render: {} takes x,y,z in metres, not \"{}\"", option, text));
    return glm::vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

}  // namespace

cli::Result<Size> read_size(const std::string& text) {
    Size size;
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.width);
    const bool has_x = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = has_x ? std::from_chars(width.ptr + 1, end, size.height) : width;
    const bool is_size = has_x && height.ec == std::errc() && height.ptr == end;
    if (!is_size || size.width < 1 || size.height < 1 || size.width > max_side || size.height > max_side ||
        size.width * size.height > max_pixels)
        return cli::fail(
            cli::exit_usage,
            fmt::format("render: --size takes WIDTHxHEIGHT, each 1 to {}, together at most 64 million "
                        "pixels, not \"{}\"",
                        max_side,
                        text));
    return size;
}

cli::Result<std::optional<View>> read_view(const RenderRequest& request) {
    if (!request.camera || !request.look)
        return std::optional<View>();
    const auto eye = read_place(*request.camera, "--camera");
    if (!eye)
        return tl::unexpected(eye.error());
    const auto look = read_place(*request.look, "--look");
    if (!look)
        return tl::unexpected(look.error());
    if (glm::distance(*eye, *look) < min_look_m)
        return cli::fail(cli::exit_usage, "render: --look is the camera's own place");
    return std::optional<View>({*eye, *look});
}

cli::Result<std::optional<trace::WorldRectangle>> read_region(const std::optional<std::string>& text) {
    if (!text)
        return std::optional<trace::WorldRectangle>();
    const auto n = cli::number_list(*text, 4);
    const bool fits =
        n && are_in_world(*n) && (*n)[2] - (*n)[0] >= min_side_m && (*n)[3] - (*n)[1] >= min_side_m;
    if (!fits)
        return cli::fail(
            cli::exit_usage,
            fmt::format("render: --region takes X0,Y0,X1,Y1 of the world, at least {} m a side, not \"{}\"",
                        min_side_m,
                        *text));
    return std::optional<trace::WorldRectangle>({glm::vec2((*n)[0], (*n)[1]), glm::vec2((*n)[2], (*n)[3])});
}

// No minus before 0.
glm::dvec3 in_millimetres(const glm::vec3& place) {
    return glm::round(glm::dvec3(place) * 1000.0) / 1000.0 + 0.0;
}

std::string place_text(const glm::vec3& place) {
    const glm::dvec3 rounded = in_millimetres(place);
    return fmt::format("{},{},{}", rounded.x, rounded.y, rounded.z);
}

}  // namespace drtv::picture
