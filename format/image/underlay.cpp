#include "underlay.h"

#include "cli/number_list.h"
#include "folder/whole_file.h"

#include <algorithm>
#include <cmath>

namespace drtv::image {

cli::Result<Underlay> Underlay::read(const std::string& path) {
    const auto file = folder::read_whole(path);
    if (!file)
        return tl::unexpected(file.error());
    const std::span png(reinterpret_cast<const std::uint8_t*>(file->data()), file->size());
    auto image = decode_png(png);
    if (!image)
        return cli::fail(image.error().code, path + ": " + image.error().sentence);
    const auto text = png_text(png, world_rectangle_key);
    const auto world = cli::number_list(text.value_or(""), 4);
    if (!world || !((*world)[0] < (*world)[2] && (*world)[1] < (*world)[3])) {
        return cli::fail(cli::exit_invalid,
                         path +
                             " does not say which part of the world it shows; bakerd render --top makes such "
                             "pictures, and drtv preview");
    }
    return Underlay(std::move(*image), {(*world)[0], (*world)[1], (*world)[2], (*world)[3]});
}

const std::uint8_t* Underlay::at(double x_m, double y_m) const {
    const auto& [x0, y0, x1, y1] = world_;
    const double x = std::floor((x_m - x0) / (x1 - x0) * static_cast<double>(image_.width));
    const double y = std::floor((y1 - y_m) / (y1 - y0) * static_cast<double>(image_.height));
    const bool is_inside =
        x >= 0 && y >= 0 && x < static_cast<double>(image_.width) && y < static_cast<double>(image_.height);
    return is_inside ? image_.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y)) : nullptr;
}

}  // namespace drtv::image
