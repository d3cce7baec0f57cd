#include "commands.h"
#include "diff_report.h"
#include "kit/exit_code.h"
#include "kit/files.h"
#include "region_picture.h"
#include "sector_diff.h"

#include <algorithm>
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
    const double share = std::clamp(decades / red_decades, 0.0, 1.0);
    const double red = std::min(1.0, 2 * share);
    const double green = std::min(1.0, 2 - 2 * share);
    return {static_cast<float>(red), static_cast<float>(green), 0};
}

std::optional<Side> files_of(const std::string& path, int& exit_code) {
    const auto files = kit::sector_files(path);
    if (!files) {
        exit_code = kit::exit_unreadable;
        return std::nullopt;
    }
    Side side;
    for (const std::string& file : *files) {
        const std::optional<Sector> sector = kit::load_sector(file, exit_code);
        if (!sector)
            return std::nullopt;
        const SectorPlace place = {sector->i, sector->j};
        const auto [entry, added] = side.try_emplace(place, file);
        if (added)
            continue;
        kit::complain(entry->second + " and " + file + " hold the same sector " + text(place));
        exit_code = kit::exit_invalid;
        return std::nullopt;
    }
    return side;
}

void draw_dots(const Sector& first, const Sector& second, const SectorDiff& diff, RegionPicture& picture) {
    picture.add(second, [&](std::size_t p, float) {
        return diff.match[p] == no_match ? added_colour : change_colour(diff.relit[p]);
    });
    for (const std::size_t p : diff.removed) {
        const Probe& probe = first.probes[p];
        const auto [x, y, z] = position_m(first, probe);
        picture.dots.push_back({x, y, z, 1, probe.kind, removed_colour});
    }
}

// A sector of both sides: compared, told where it differs, and drawn. Gives the exit code, as the next does.
int compare_sector(const SectorPlace& place,
                   const std::string& first_file,
                   const std::string& second_file,
                   Comparison& comparison) {
    int exit_code = kit::exit_valid;
    const std::optional<Sector> first = kit::load_sector(first_file, exit_code);
    const std::optional<Sector> second = first ? kit::load_sector(second_file, exit_code) : std::nullopt;
    if (!second)
        return exit_code;
    const SectorDiff diff = diff_sectors(*first, *second);
    draw_dots(*first, *second, diff, comparison.picture);
    DiffTotals& totals = comparison.totals;
    ++totals.compared;
    if (diff.equal())
        return kit::exit_valid;
    ++totals.different;
    for (std::size_t q = 0; q < quantity_count; ++q)
        totals.changes[q].merge(diff.changes[q], "sector " + text(place) + " ");
    comparison.report.add(place, diff, second->probes.size());
    return kit::exit_valid;
}

int add_single(const std::string& file, const Float3& colour, RegionPicture& picture) {
    int exit_code = kit::exit_valid;
    const std::optional<Sector> sector = kit::load_sector(file, exit_code);
    if (sector)
        picture.add(*sector, [&](std::size_t, float) { return colour; });
    return exit_code;
}

int compare_sides(const Side& first, const Side& second, Comparison& comparison) {
    int exit_code = kit::exit_valid;
    for (const auto& [place, file] : second) {
        const auto before = first.find(place);
        if (before == first.end()) {
            comparison.totals.only_second.push_back(place);
            exit_code = add_single(file, added_colour, comparison.picture);
        } else {
            exit_code = compare_sector(place, before->second, file, comparison);
        }
        if (exit_code != kit::exit_valid)
            return exit_code;
    }
    for (const auto& [place, file] : first) {
        if (second.contains(place))
            continue;
        comparison.totals.only_first.push_back(place);
        exit_code = add_single(file, removed_colour, comparison.picture);
        if (exit_code != kit::exit_valid)
            return exit_code;
    }
    return kit::exit_valid;
}

int write_picture(const RegionPicture& picture, const DiffRequest& request) {
    const auto image = draw(picture, request.metres_per_pixel);
    if (!image)
        return kit::exit_usage;
    const std::string error = kit::write_png_file(*request.png, kit::encode_png(*image));
    if (!error.empty()) {
        kit::complain(error);
        return kit::exit_unreadable;
    }
    if (request.json)
        return kit::exit_valid;
    std::printf(
        "%s: grey is equal; green changed by %g or less of a white sky, yellow by %g, red by %g or more; "
        "blue is new, magenta gone\n",
        request.png->c_str(),
        min_shown_change,
        std::sqrt(min_shown_change * red_change),
        red_change);
    return kit::exit_valid;
}

}  // namespace

int run_diff(const DiffRequest& request) {
    int exit_code = kit::exit_valid;
    const auto first = files_of(request.first, exit_code);
    const auto second = first ? files_of(request.second, exit_code) : std::nullopt;
    if (!second)
        return exit_code;

    Comparison comparison{{}, DiffReport(request.json), {}};
    exit_code = compare_sides(*first, *second, comparison);
    if (exit_code != kit::exit_valid)
        return exit_code;
    comparison.report.finish(comparison.totals);
    if (request.png)
        exit_code = write_picture(comparison.picture, request);
    if (exit_code != kit::exit_valid)
        return exit_code;
    return comparison.totals.equal() ? kit::exit_valid : kit::exit_different;
}

}  // namespace drtv::tool
