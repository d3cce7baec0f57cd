#include "commands.h"
#include "dot_colour.h"
#include "kit/exit_code.h"
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

int run_preview(const PreviewRequest& request) {
    const auto* quantity =
        std::ranges::find(quantities, request.quantity, &std::pair<std::string_view, DotQuantity>::first);
    if (quantity == quantities.end())
        return kit::exit_usage;
    const auto files = kit::sector_files(request.path);
    if (!files)
        return kit::exit_unreadable;
    RegionPicture picture;
    for (const std::string& file : *files) {
        int exit_code = kit::exit_valid;
        const std::optional<Sector> sector = kit::load_sector(file, exit_code);
        if (!sector)
            return exit_code;
        picture.add(*sector, [&](std::size_t p, float sky_visibility) {
            return dot_colour(*sector, p, sky_visibility, quantity->second);
        });
    }
    std::optional<Underlay> under;
    std::error_code code;
    if (request.under && std::filesystem::equivalent(*request.under, request.out, code)) {
        kit::complain("preview: --out would replace the picture of --under, " + *request.under);
        return kit::exit_usage;
    }
    if (request.under) {
        int exit_code = kit::exit_valid;
        under = Underlay::read(*request.under, exit_code);
        if (!under)
            return exit_code;
    }
    const auto image = draw(picture, request.metres_per_pixel, under ? &*under : nullptr);
    if (!image)
        return kit::exit_usage;
    const kit::FileBytes png = kit::encode_png(*image);
    const std::string error =
        png.empty() ? "memory is too short for the picture" : kit::write_png_file(request.out, png);
    if (!error.empty()) {
        kit::complain(error);
        return kit::exit_unreadable;
    }
    std::printf("%s: %zu x %zu pixels, %zu sector%s, %zu probes\n",
                request.out.c_str(),
                image->width,
                image->height,
                files->size(),
                files->size() == 1 ? "" : "s",
                picture.dots.size());
    return kit::exit_valid;
}

}  // namespace drtv::tool
