#include "arguments.h"
#include "commands.h"
#include "files.h"
#include "json_writer.h"
#include "region_picture.h"
#include "sector_diff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

namespace drtv::tool {
namespace {

using Place = std::array<std::int32_t, 2>;
using Side = std::map<Place, std::string>;  // the file of each sector

struct Comparison {
    std::size_t compared = 0, different = 0;
    std::vector<Place> only_first, only_second;
    std::array<Change, quantity_count> changes;
    RegionPicture picture;
    JsonWriter json;
    bool as_json = false;
};

// Sectors of one side that are named one by one; --json names all.
constexpr std::size_t most_named = 10;

// Relit change at which a dot is red.
constexpr double red_change = 0.1, least_shown_change = 1e-4;
constexpr Float3 same_colour = {0.05f, 0.05f, 0.05f}, added_colour = {0.1f, 0.3f, 1},
                 removed_colour = {0.9f, 0, 0.9f};

// Grey where nothing changed, then from green over yellow to red, by the logarithm.
Float3 change_colour(double change) {
    if (change <= 0)
        return same_colour;
    const double share = std::clamp(
        std::log(change / least_shown_change) / std::log(red_change / least_shown_change), 0.0, 1.0);
    return {
        static_cast<float>(std::min(1.0, 2 * share)), static_cast<float>(std::min(1.0, 2 - 2 * share)), 0};
}

std::string text(const Place& place) {
    return "(" + std::to_string(place[0]) + ", " + std::to_string(place[1]) + ")";
}

std::optional<Side> files_of(const std::string& path, int& exit_code) {
    const auto files = sector_files(path);
    if (!files) {
        exit_code = exit_unreadable;
        return std::nullopt;
    }
    Side side;
    for (const std::string& file : *files) {
        const std::optional<Sector> sector = load_sector(file, exit_code);
        if (!sector)
            return std::nullopt;
        const auto [entry, added] = side.try_emplace({sector->i, sector->j}, file);
        if (added)
            continue;
        complain(entry->second + " and " + file + " hold the same sector " + text({sector->i, sector->j}));
        exit_code = exit_invalid;
        return std::nullopt;
    }
    return side;
}

void print_changes(const std::array<Change, quantity_count>& changes) {
    for (std::size_t q = 0; q < quantity_count; ++q) {
        if (changes[q].largest > 0)
            std::printf("  %-18s at most %-12g rms %-12g %s\n",
                        std::string(quantity_names[q]).c_str(),
                        changes[q].largest,
                        changes[q].rms(),
                        changes[q].at.c_str());
    }
}

void print_sector(const Place& place, const SectorDiff& diff, std::size_t probes) {
    std::printf("sector %s: %zu of %zu probes changed, %zu added, %zu removed; %zu grid cells",
                text(place).c_str(),
                diff.changed,
                probes,
                diff.added,
                diff.removed.size(),
                diff.cells);
    if (diff.pairs_added + diff.pairs_removed > 0)
        std::printf("; %zu local pairs added, %zu removed", diff.pairs_added, diff.pairs_removed);
    for (const auto& [differs, name] : {std::pair(diff.settings, "settings"),
                                        std::pair(diff.statistics, "statistics"),
                                        std::pair(diff.convergence, "the convergence"),
                                        std::pair(diff.interiors, "interiors"),
                                        std::pair(diff.grid_place, "the grid's place")}) {
        if (differs)
            std::printf("; %s differ%s", name, name[0] == 't' ? "s" : "");
    }
    std::printf("\n");
    print_changes(diff.changes);
}

void append_changes(JsonWriter& json, const std::array<Change, quantity_count>& changes) {
    json.key("changes").begin_object();
    for (std::size_t q = 0; q < quantity_count; ++q) {
        json.key(quantity_names[q])
            .begin_object()
            .key("largest")
            .value(changes[q].largest)
            .key("rms")
            .value(changes[q].rms())
            .key("at")
            .value(changes[q].at)
            .end_object();
    }
    json.end_object();
}

void append_sector(JsonWriter& json, const Place& place, const SectorDiff& diff, std::size_t probes) {
    json.begin_object()
        .key("sector")
        .array(place)
        .key("probes")
        .value(std::uint64_t{probes})
        .key("changed")
        .value(std::uint64_t{diff.changed});
    json.key("added")
        .value(std::uint64_t{diff.added})
        .key("removed")
        .value(std::uint64_t{diff.removed.size()})
        .key("grid_cells")
        .value(std::uint64_t{diff.cells});
    json.key("local_pairs_added")
        .value(std::uint64_t{diff.pairs_added})
        .key("local_pairs_removed")
        .value(std::uint64_t{diff.pairs_removed});
    json.key("settings")
        .value(diff.settings)
        .key("statistics")
        .value(diff.statistics)
        .key("convergence")
        .value(diff.convergence)
        .key("interiors")
        .value(diff.interiors)
        .key("grid_place")
        .value(diff.grid_place);
    append_changes(json, diff.changes);
    json.end_object();
}

void append_places(JsonWriter& json, const char* key, const std::vector<Place>& places) {
    json.key(key).begin_array();
    for (const Place& place : places)
        json.array(place);
    json.end_array();
}

// A sector of both sides: compared, told where it differs, and drawn.
int compare_sector(const Place& place,
                   const std::string& first_file,
                   const std::string& second_file,
                   Comparison& comparison) {
    int exit_code = exit_valid;
    const std::optional<Sector> first = load_sector(first_file, exit_code);
    const std::optional<Sector> second = first ? load_sector(second_file, exit_code) : std::nullopt;
    if (!second)
        return exit_code;
    const SectorDiff diff = diff_sectors(*first, *second);
    ++comparison.compared;
    comparison.picture.add(*second, [&](std::size_t p, float) {
        return diff.match[p] == no_match ? added_colour : change_colour(diff.relit[p]);
    });
    for (const std::size_t p : diff.removed) {
        const Float3 position = position_m(*first, first->probes[p]);
        comparison.picture.dots.push_back(
            {position[0], position[1], position[2], 1, first->probes[p].kind, removed_colour});
    }
    if (diff.equal())
        return exit_valid;
    ++comparison.different;
    for (std::size_t q = 0; q < quantity_count; ++q)
        comparison.changes[q].merge(diff.changes[q], "sector " + text(place) + " ");
    if (comparison.as_json)
        append_sector(comparison.json, place, diff, second->probes.size());
    else
        print_sector(place, diff, second->probes.size());
    return exit_valid;
}

int add_single(const std::string& file, const Float3& colour, Comparison& comparison) {
    int exit_code = exit_valid;
    const std::optional<Sector> sector = load_sector(file, exit_code);
    if (sector)
        comparison.picture.add(*sector, [&](std::size_t, float) { return colour; });
    return exit_code;
}

void print_summary(const Comparison& comparison) {
    for (const auto& [places, name] :
         {std::pair(&comparison.only_first, "first"), std::pair(&comparison.only_second, "second")}) {
        for (std::size_t n = 0; n < std::min(places->size(), most_named); ++n)
            std::printf("sector %s: only in the %s\n", text((*places)[n]).c_str(), name);
        if (places->size() > most_named)
            std::printf("and %zu more only in the %s\n", places->size() - most_named, name);
    }
    std::printf("%zu sector%s compared, %zu differ; %zu only in the first, %zu only in the second\n",
                comparison.compared,
                comparison.compared == 1 ? "" : "s",
                comparison.different,
                comparison.only_first.size(),
                comparison.only_second.size());
    print_changes(comparison.changes);
}

}  // namespace

int run_diff(Arguments arguments) {
    const auto parsed = ParsedArguments::parse(
        "diff", arguments, {{"--json"}, {"--png", true}, {"--metres-per-pixel", true}});
    if (!parsed)
        return exit_usage;
    const auto metres_per_pixel = parsed->positive("--metres-per-pixel", 1000, 0);
    if (!metres_per_pixel)
        return exit_usage;
    if (parsed->has("--metres-per-pixel") && !parsed->has("--png")) {
        complain("diff: --metres-per-pixel is for the picture, and there is no --png");
        return exit_usage;
    }
    if (parsed->positional.size() != 2) {
        complain("diff needs two files or folders");
        return exit_usage;
    }
    int exit_code = exit_valid;
    const auto first = files_of(parsed->positional[0], exit_code);
    const auto second = first ? files_of(parsed->positional[1], exit_code) : std::nullopt;
    if (!second)
        return exit_code;

    Comparison comparison;
    comparison.as_json = parsed->has("--json");
    comparison.json.begin_object().key("sectors").begin_array();
    for (const auto& [place, file] : *second) {
        const auto before = first->find(place);
        if (before == first->end())
            comparison.only_second.push_back(place);
        exit_code = before == first->end() ? add_single(file, added_colour, comparison)
                                           : compare_sector(place, before->second, file, comparison);
        if (exit_code != exit_valid)
            return exit_code;
    }
    for (const auto& [place, file] : *first) {
        if (second->contains(place))
            continue;
        comparison.only_first.push_back(place);
        if (exit_code = add_single(file, removed_colour, comparison); exit_code != exit_valid)
            return exit_code;
    }
    if (comparison.as_json) {
        comparison.json.end_array();
        append_places(comparison.json, "only_first", comparison.only_first);
        append_places(comparison.json, "only_second", comparison.only_second);
        comparison.json.key("compared")
            .value(std::uint64_t{comparison.compared})
            .key("different")
            .value(std::uint64_t{comparison.different});
        append_changes(comparison.json, comparison.changes);
        std::puts(comparison.json.end_object().text().c_str());
    } else {
        print_summary(comparison);
    }
    if (parsed->has("--png")) {
        const auto image = draw(comparison.picture, *metres_per_pixel);
        if (!image)
            return exit_usage;
        if (std::string error; !write_file(parsed->value("--png"), encode_png(*image), error)) {
            complain(error);
            return exit_unreadable;
        }
        if (!comparison.as_json)
            std::printf(
                "%s: grey is equal; green changed by %g or less of a white sky, yellow by %g, red by %g or "
                "more; blue is new, magenta gone\n",
                parsed->value("--png").c_str(),
                least_shown_change,
                std::sqrt(least_shown_change * red_change),
                red_change);
    }
    return comparison.different + comparison.only_first.size() + comparison.only_second.size() == 0
               ? exit_valid
               : exit_different;
}

}  // namespace drtv::tool
