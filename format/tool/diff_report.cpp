#include "diff_report.h"

#include <algorithm>
#include <cstdio>

namespace drtv::tool {
namespace {

using Changes = std::array<QuantityChange, quantity_count>;

// Sectors of one side that are named one by one; --json names all.
constexpr std::size_t max_named = 10;

void print_changes(const Changes& changes) {
    for (std::size_t q = 0; q < quantity_count; ++q) {
        const QuantityChange& change = changes[q];
        if (change.largest > 0)
            std::printf("  %-18s at most %-12g rms %-12g %s\n",
                        std::string(quantity_names[q]).c_str(),
                        change.largest,
                        change.rms(),
                        change.at.c_str());
    }
}

void print_groups(const std::vector<std::string>& names, const char* side) {
    for (const std::string& name : names)
        std::printf("; light group '%s' only in the %s", name.c_str(), side);
}

void print_sector(const SectorPlace& place, const SectorDiff& diff, std::size_t probes) {
    std::printf("sector %s: %zu of %zu probes changed, %zu added, %zu removed; %zu grid cells",
                text(place).c_str(),
                diff.changed,
                probes,
                diff.added,
                diff.removed.size(),
                diff.cells);
    if (diff.pairs_added + diff.pairs_removed > 0)
        std::printf("; %zu local pairs added, %zu removed", diff.pairs_added, diff.pairs_removed);
    const auto tell = [](bool differs, const char* sentence) {
        if (differs)
            std::printf("; %s", sentence);
    };
    tell(diff.settings, "settings differ");
    tell(diff.statistics, "statistics differ");
    tell(diff.convergence, "the convergence differs");
    tell(diff.interiors, "interiors differ");
    tell(diff.quality, "the quality differs");
    tell(diff.grid_place, "the grid's place differs");
    print_groups(diff.groups_only_first, "first");
    print_groups(diff.groups_only_second, "second");
    std::printf("\n");
    print_changes(diff.changes);
}

void print_places(const std::vector<SectorPlace>& places, const char* side) {
    const std::size_t named = std::min(places.size(), max_named);
    for (std::size_t n = 0; n < named; ++n)
        std::printf("sector %s: only in the %s\n", text(places[n]).c_str(), side);
    if (places.size() > named)
        std::printf("and %zu more only in the %s\n", places.size() - named, side);
}

void print_totals(const DiffTotals& totals) {
    print_places(totals.only_first, "first");
    print_places(totals.only_second, "second");
    std::printf("%zu sector%s compared, %zu differ; %zu only in the first, %zu only in the second\n",
                totals.compared,
                totals.compared == 1 ? "" : "s",
                totals.different,
                totals.only_first.size(),
                totals.only_second.size());
    print_changes(totals.changes);
}

void append_changes(kit::JsonWriter& json, const Changes& changes) {
    json.key("changes").begin_object();
    for (std::size_t q = 0; q < quantity_count; ++q) {
        const QuantityChange& change = changes[q];
        json.key(quantity_names[q]).begin_object();
        json.member("largest", change.largest);
        json.member("rms", change.rms());
        json.member("at", change.at);
        json.end_object();
    }
    json.end_object();
}

void append_sector(kit::JsonWriter& json,
                   const SectorPlace& place,
                   const SectorDiff& diff,
                   std::size_t probes) {
    json.begin_object();
    json.key("sector").array(place);
    json.count("probes", probes);
    json.count("changed", diff.changed);
    json.count("added", diff.added);
    json.count("removed", diff.removed.size());
    json.count("grid_cells", diff.cells);
    json.count("local_pairs_added", diff.pairs_added);
    json.count("local_pairs_removed", diff.pairs_removed);
    json.member("settings", diff.settings);
    json.member("statistics", diff.statistics);
    json.member("convergence", diff.convergence);
    json.member("interiors", diff.interiors);
    json.member("quality", diff.quality);
    json.member("grid_place", diff.grid_place);
    json.key("light_groups_only_first").array(diff.groups_only_first);
    json.key("light_groups_only_second").array(diff.groups_only_second);
    append_changes(json, diff.changes);
    json.end_object();
}

void append_places(kit::JsonWriter& json, const char* key, const std::vector<SectorPlace>& places) {
    json.key(key).begin_array();
    for (const SectorPlace& place : places)
        json.array(place);
    json.end_array();
}

}  // namespace

std::string text(const SectorPlace& place) {
    return "(" + std::to_string(place[0]) + ", " + std::to_string(place[1]) + ")";
}

bool DiffTotals::equal() const {
    return different == 0 && only_first.empty() && only_second.empty();
}

DiffReport::DiffReport(bool as_json) : as_json_(as_json) {
    json_.begin_object().key("sectors").begin_array();
}

void DiffReport::add(const SectorPlace& place, const SectorDiff& diff, std::size_t probes) {
    if (as_json_)
        append_sector(json_, place, diff, probes);
    else
        print_sector(place, diff, probes);
}

void DiffReport::finish(const DiffTotals& totals) {
    if (!as_json_) {
        print_totals(totals);
        return;
    }
    json_.end_array();
    append_places(json_, "only_first", totals.only_first);
    append_places(json_, "only_second", totals.only_second);
    json_.count("compared", totals.compared);
    json_.count("different", totals.different);
    append_changes(json_, totals.changes);
    json_.end_object();
    std::puts(json_.text().c_str());
}

}  // namespace drtv::tool
