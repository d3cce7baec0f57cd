#include "arguments.h"
#include "commands.h"
#include "dot_colour.h"
#include "files.h"
#include "region_picture.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>

namespace drtv::tool {
namespace {

constexpr std::array<std::pair<std::string_view, DotQuantity>, 4> quantities = {
    {{"relit", DotQuantity::relit},
     {"sky", DotQuantity::sky},
     {"errors", DotQuantity::errors},
     {"back_hits", DotQuantity::back_hits}}};

struct PreviewArguments {
    std::string folder, out;
    double metres_per_pixel = 0;
    DotQuantity quantity = DotQuantity::relit;
};

std::optional<PreviewArguments> parse(Arguments arguments) {
    const auto parsed = ParsedArguments::parse(
        "preview", arguments, {{"--out", true}, {"--metres-per-pixel", true}, {"--quantity", true}});
    if (!parsed)
        return std::nullopt;
    PreviewArguments preview;
    const auto metres_per_pixel = parsed->positive("--metres-per-pixel", 1000, 0);
    if (!metres_per_pixel)
        return std::nullopt;
    preview.metres_per_pixel = *metres_per_pixel;
    if (parsed->has("--quantity")) {
        const auto* quantity = std::ranges::find(
            quantities, parsed->value("--quantity"), &std::pair<std::string_view, DotQuantity>::first);
        if (quantity == quantities.end()) {
            complain("preview: --quantity takes relit, sky, errors or back_hits, not \"" +
                     parsed->value("--quantity") + "\"");
            return std::nullopt;
        }
        preview.quantity = quantity->second;
    }
    if (parsed->positional.size() > 1) {
        complain("preview takes one folder or file, \"" + parsed->positional[1] + "\" is one too many");
        return std::nullopt;
    }
    if (parsed->positional.empty() || parsed->value("--out").empty()) {
        complain("usage is: drtv preview DIR --out FILE.png");
        return std::nullopt;
    }
    preview.folder = parsed->positional.front();
    preview.out = parsed->value("--out");
    return preview;
}

}  // namespace

int run_preview(Arguments arguments) {
    const auto parsed = parse(arguments);
    if (!parsed)
        return exit_usage;
    const auto files = sector_files(parsed->folder);
    if (!files)
        return exit_unreadable;
    RegionPicture picture;
    for (const std::string& file : *files) {
        int exit_code = exit_valid;
        const std::optional<Sector> sector = load_sector(file, exit_code);
        if (!sector)
            return exit_code;
        picture.add(*sector, [&](std::size_t p, float sky_visibility) {
            return dot_colour(*sector, p, sky_visibility, parsed->quantity);
        });
    }
    const auto image = draw(picture, parsed->metres_per_pixel);
    if (!image)
        return exit_usage;
    const std::string error = write_file(parsed->out, encode_png(*image));
    if (!error.empty()) {
        complain(error);
        return exit_unreadable;
    }
    std::printf("%s: %zu x %zu pixels, %zu sector%s, %zu probes\n",
                parsed->out.c_str(),
                image->width,
                image->height,
                files->size(),
                files->size() == 1 ? "" : "s",
                picture.dots.size());
    return exit_valid;
}

}  // namespace drtv::tool
