#include "underlay.h"

#include "cli/number_list.h"
#include "folder/whole_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>

namespace drtv::image {
namespace {

// x0, y0, x1, y1 of a text in the file; nothing where there is none that is one.
std::optional<std::array<double, 4>> rectangle(std::span<const std::uint8_t> png, const char* key) {
    const auto numbers = cli::number_list(png_text(png, key).value_or(""), 4);
    if (!numbers || !((*numbers)[0] < (*numbers)[2] && (*numbers)[1] < (*numbers)[3]))
        return std::nullopt;
    return std::array{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
}

}  // namespace

cli::Result<Underlay> Underlay::read(const std::string& path, const std::string& target) {
    std::error_code code;
    if (std::filesystem::equivalent(path, target, code))
        return cli::fail(cli::exit_usage, target + " would replace the picture of --under");
    const auto file = folder::read_whole(path);
    if (!file)
        return tl::unexpected(file.error());
    const std::span png(reinterpret_cast<const std::uint8_t*>(file->data()), file->size());
    auto image = decode_png(png);
    if (!image)
        return cli::fail(image.error().code, path + ": " + image.error().sentence);
    const auto world = rectangle(png, world_rectangle_key);
    if (!world) {
        return cli::fail(
            cli::exit_invalid,
            path + " does not say which part of the world it shows; bakerd render --top makes such pictures");
    }
    const Rectangle whole = {0, 0, static_cast<double>(image->width), static_cast<double>(image->height)};
    const Rectangle map = rectangle(png, map_rectangle_key).value_or(whole);
    return Underlay(std::move(*image), *world, map);
}

const std::uint8_t* Underlay::at(double x_m, double y_m) const {
    const auto& [x0, y0, x1, y1] = world_;
    const auto width = static_cast<double>(image_.width);
    const auto height = static_cast<double>(image_.height);
    const double x = std::floor((x_m - x0) / (x1 - x0) * width);
    const double y = std::floor((y1 - y_m) / (y1 - y0) * height);
    const bool is_inside = x >= std::max(0.0, map_[0]) && y >= std::max(0.0, map_[1]) &&
                           x < std::min(width, map_[2]) && y < std::min(height, map_[3]);
    return is_inside ? image_.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y)) : nullptr;
}

}  // namespace drtv::image
