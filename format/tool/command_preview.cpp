#include "commands.h"
#include "dot_colour.h"
#include "kit/files.h"
#include "region_picture.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace drtv::tool {
namespace {

constexpr std::array<std::pair<std::string_view, DotQuantity>, 4> quantities = {
    {{"relit", DotQuantity::relit},
     {"sky", DotQuantity::sky},
     {"errors", DotQuantity::errors},
     {"back_hits", DotQuantity::back_hits}}};

}  // namespace

std::vector<std::string> preview_quantities() {
    std::vector<std::string> names;
    for (const auto& [name, quantity] : quantities)
        names.emplace_back(name);
    return names;
}

cli::Result<cli::ExitCode> run_preview(const PreviewRequest& request) {
    const auto* quantity =
        std::ranges::find(quantities, request.quantity, &std::pair<std::string_view, DotQuantity>::first);
    if (quantity == quantities.end())
        return cli::fail(cli::exit_usage, "preview: there is no quantity \"" + request.quantity + "\"");
    const auto files = kit::sector_files(request.path);
    if (!files)
        return tl::unexpected(files.error());
    RegionPicture picture;
    for (const std::string& file : *files) {
        const auto sector = kit::load_sector(file);
        if (!sector)
            return tl::unexpected(sector.error());
        picture.add(*sector, [&](std::size_t p, float sky_visibility) {
            return dot_colour(*sector, p, sky_visibility, quantity->second);
        });
    }
    std::optional<Underlay> under;
    std::error_code code;
    if (request.under && std::filesystem::equivalent(*request.under, request.out, code)) {
        return cli::fail(cli::exit_usage,
                         "preview: --out would replace the picture of --under, " + *request.under);
    }
    if (request.under) {
        auto read = Underlay::read(*request.under);
        if (!read)
            return tl::unexpected(read.error());
        under = std::move(*read);
    }
    const auto image = draw(picture, request.metres_per_pixel, under ? &*under : nullptr);
    if (!image)
        return tl::unexpected(image.error());
    const auto written = kit::encode_png(*image).and_then(
        [&](const kit::FileBytes& png) { return kit::write_png_file(request.out, png); });
    if (!written)
        return tl::unexpected(written.error());
    std::printf("%s: %zu x %zu pixels, %zu sector%s, %zu probes\n",
                request.out.c_str(),
                image->width,
                image->height,
                files->size(),
                files->size() == 1 ? "" : "s",
                picture.dots.size());
    return cli::exit_done;
}

}  // namespace drtv::tool
