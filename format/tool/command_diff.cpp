#include "cli/report.h"
#include "commands.h"
#include "diff_report.h"
#include "dot_colour.h"
#include "folder/manifest.h"
#include "image/png_file.h"
#include "kit/files.h"
#include "region_picture.h"
#include "sector_diff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>

namespace drtv::tool {
namespace {

using Side = std::map<SectorPlace, std::string>;  // the file of each sector

struct Comparison {
    DiffTotals totals;
    DiffReport report;
    RegionPicture picture;
};

// Relit change at which a dot is red.
constexpr double red_change = 0.1;
constexpr double min_shown_change = 1e-4;
constexpr Float3 same_colour = {0.05f, 0.05f, 0.05f};
constexpr Float3 added_colour = {0.1f, 0.3f, 1};
constexpr Float3 removed_colour = {0.9f, 0, 0.9f};

// Grey where nothing changed, then from green over yellow to red, by the logarithm.
Float3 change_colour(double change) {
    if (change <= 0)
        return same_colour;
    const double decades = std::log(change / min_shown_change);
    const double red_decades = std::log(red_change / min_shown_change);
    return traffic_light(static_cast<float>(std::clamp(decades / red_decades, 0.0, 1.0)));
}

cli::Result<Side> files_of(const std::string& path) {
    const auto files = kit::sector_files(path);
    if (!files)
        return tl::unexpected(files.error());
    folder::warn_of_pull(path);
    Side side;
    for (const std::string& file : *files) {
        const auto sector = kit::load_sector(file);
        if (!sector)
            return tl::unexpected(sector.error());
        const SectorPlace place = {sector->i, sector->j};
        const auto [entry, added] = side.try_emplace(place, file);
        if (!added) {
            return cli::fail(cli::exit_invalid,
                             entry->second + " and " + file + " hold the same sector " + text(place));
        }
    }
    return side;
}

void draw_dots(const Sector& first, const Sector& second, const SectorDiff& diff, RegionPicture& picture) {
    picture.add(second, [&](const Sector&, std::size_t p, float) {
        return diff.match[p] == no_match ? added_colour : change_colour(diff.relit[p]);
    });
    for (const std::size_t p : diff.removed) {
        const Probe& probe = first.probes[p];
        const auto [x, y, z] = position_m(first, probe);
        picture.dots.push_back({x, y, z, 1, probe.kind, removed_colour});
    }
}

// A sector of both sides: compared, told where it differs, and drawn.
cli::Result<void> compare_sector(const SectorPlace& place,
                                 const std::string& first_file,
                                 const std::string& second_file,
                                 Comparison& comparison) {
    const auto first = kit::load_sector(first_file);
    if (!first)
        return tl::unexpected(first.error());
    const auto second = kit::load_sector(second_file);
    if (!second)
        return tl::unexpected(second.error());
    const SectorDiff diff = diff_sectors(*first, *second);
    draw_dots(*first, *second, diff, comparison.picture);
    DiffTotals& totals = comparison.totals;
    ++totals.compared;
    if (diff.equal())
        return {};
    ++totals.different;
    for (std::size_t q = 0; q < quantity_count; ++q)
        totals.changes[q].merge(diff.changes[q], "sector " + text(place) + " ");
    comparison.report.add(place, diff, second->probes.size());
    return {};
}

cli::Result<void> add_single(const std::string& file, const Float3& colour, RegionPicture& picture) {
    const auto sector = kit::load_sector(file);
    if (!sector)
        return tl::unexpected(sector.error());
    picture.add(*sector, [&](const Sector&, std::size_t, float) { return colour; });
    return {};
}

cli::Result<void> compare_sides(const Side& first, const Side& second, Comparison& comparison) {
    for (const auto& [place, file] : second) {
        const auto before = first.find(place);
        const bool is_new = before == first.end();
        if (is_new)
            comparison.totals.only_second.push_back(place);
        auto done = is_new ? add_single(file, added_colour, comparison.picture)
                           : compare_sector(place, before->second, file, comparison);
        if (!done)
            return done;
    }
    for (const auto& [place, file] : first) {
        if (second.contains(place))
            continue;
        comparison.totals.only_first.push_back(place);
        if (auto done = add_single(file, removed_colour, comparison.picture); !done)
            return done;
    }
    return {};
}

std::string percent_text(double share) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2g %% of a white sky", 100 * share);
    return text.data();
}

cli::Result<void> write_picture(RegionPicture& picture, const DiffRequest& request) {
    picture.title = "change of relit ambient light";
    picture.legend = {{same_colour, "equal"},
                      {change_colour(min_shown_change), percent_text(min_shown_change) + " or less"},
                      {change_colour(std::sqrt(min_shown_change * red_change)),
                       percent_text(std::sqrt(min_shown_change * red_change))},
                      {change_colour(red_change), percent_text(red_change) + " or more"},
                      {added_colour, "new"},
                      {removed_colour, "gone"}};
    const auto [sheet, note] = draw(picture, request.metres_per_pixel);
    if (!note.empty())
        cli::note(note);
    auto written = image::write_png_file(*request.png, sheet.image, sheet.texts);
    if (written && !request.json)
        std::printf("%s: %zu x %zu pixels\n", request.png->c_str(), sheet.image.width, sheet.image.height);
    return written;
}

}  // namespace

cli::Result<cli::ExitCode> run_diff(const DiffRequest& request) {
    if (request.png) {
        if (auto target = image::check_png_target(*request.png); !target)
            return tl::unexpected(target.error());
    }
    const auto first = files_of(request.first);
    if (!first)
        return tl::unexpected(first.error());
    const auto second = files_of(request.second);
    if (!second)
        return tl::unexpected(second.error());

    Comparison comparison{{}, DiffReport(request.json), {}};
    if (auto done = compare_sides(*first, *second, comparison); !done)
        return tl::unexpected(done.error());
    comparison.report.finish(comparison.totals);
    if (request.png) {
        if (auto done = write_picture(comparison.picture, request); !done)
            return tl::unexpected(done.error());
    }
    return comparison.totals.equal() ? cli::exit_done : cli::exit_different;
}

}  // namespace drtv::tool
