#include "cli/report.h"
#include "commands.h"
#include "folder/manifest.h"
#include "image/png_file.h"
#include "kit/files.h"
#include "region_picture.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

namespace drtv::tool {
namespace {

std::string count_of(std::size_t count, const std::string& word) {
    return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

cli::Result<std::optional<image::Underlay>> read_underlay(const PreviewRequest& request) {
    if (!request.under)
        return std::nullopt;
    auto read = image::Underlay::read(*request.under, request.out);
    if (!read)
        return tl::unexpected(read.error());
    return std::move(*read);
}

}  // namespace

cli::Result<cli::ExitCode> run_preview(const PreviewRequest& request) {
    const auto quantity = dot_quantity(request.quantity, request.light);
    if (!quantity)
        return tl::unexpected(quantity.error());
    if (auto target = image::check_png_target(request.out); !target)
        return tl::unexpected(target.error());
    const auto under = read_underlay(request);
    if (!under)
        return tl::unexpected(under.error());
    const auto files = kit::sector_files(request.path);
    if (!files)
        return tl::unexpected(files.error());
    folder::warn_of_pull(request.path);
    RegionPicture picture;
    bool lacks_quality = false;
    for (const std::string& file : *files) {
        const auto sector = kit::load_sector(file);
        if (!sector)
            return tl::unexpected(sector.error());
        picture.add(*sector, quantity->colour);
        lacks_quality = lacks_quality || (!sector->quality && !sector->probes.empty());
    }
    const std::string counts =
        count_of(files->size(), "sector") + ", " + count_of(picture.dots.size(), "probe");
    picture.title = quantity->words + " (" + counts + ")";
    picture.legend = quantity->legend;
    if (quantity->is_scaled)
        picture.scale_colours();
    if (quantity->needs_quality && lacks_quality)
        picture.legend.push_back({unknown_colour, "not known: files without quality"});
    if (std::ranges::count(picture.dots, ProbeKind::manual, &Dot::kind) > 0)
        picture.legend.push_back({{1, 1, 1}, "rim: hand-placed"});
    const auto [sheet, note] = draw(picture, request.metres_per_pixel, *under ? &**under : nullptr);
    if (!note.empty())
        cli::note(note);
    if (auto written = image::write_png_file(request.out, sheet.image, sheet.texts); !written)
        return tl::unexpected(written.error());
    std::printf("%s: %zu x %zu pixels, %s\n",
                request.out.c_str(),
                sheet.image.width,
                sheet.image.height,
                counts.c_str());
    return cli::exit_done;
}

}  // namespace drtv::tool
