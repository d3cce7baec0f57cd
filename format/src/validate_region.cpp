#include <drtv/validate_region.h>

#include "border_step.h"
#include "findings.h"
#include "layout.h"
#include "section_table.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace drtv {
namespace {

using Coordinate = std::pair<std::int32_t, std::int32_t>;  // (i, j)

// On real maps the largest ratio is below 3; what is dim or has few probes inside needs an absolute step too.
constexpr double most_step_ratio = 4, least_step = 0.05;

// A hole of more places than this counts as open land.
constexpr std::size_t most_walked = std::size_t{1} << 20;

std::string text(const Coordinate& sector) { return "(" + std::to_string(sector.first) + ", " + std::to_string(sector.second) + ")"; }

class Region {
  public:
    explicit Region(std::span<const RegionSector> sectors) : sectors_(sectors) {
        for (std::size_t n = 0; n < sectors.size(); ++n) {
            const auto [entry, added] = by_place_.try_emplace({sectors[n].i, sectors[n].j}, n);
            if (!added) add(n, issue::set_duplicate, layout::header::sector_i, std::nullopt, "sector " + text(entry->first) + " is in another file of the set too");
        }
    }

    void check_set() {
        std::map<std::array<std::uint8_t, 32>, std::size_t> keys;
        for (const RegionSector& sector : sectors_) ++keys[sector.bake.settings_key];
        const auto most = std::ranges::max_element(keys, {}, [](const auto& key) { return key.second; });
        for (std::size_t n = 0; n < sectors_.size(); ++n) {
            const RegionSector& sector = sectors_[n];
            if (sector.bake.settings_key != most->first) {
                add(n, issue::set_settings, 0, std::nullopt, "its settings key is that of " + std::to_string(keys[sector.bake.settings_key]) + " sectors, another is that of " + std::to_string(most->second), "settings.key");
            }
            if (sector.named && *sector.named != std::array{sector.i, sector.j}) {
                add(n, issue::set_file_name, layout::header::sector_i, std::nullopt, "the file is named for sector " + text({(*sector.named)[0], (*sector.named)[1]}) + " and holds sector " + text({sector.i, sector.j}));
            }
        }
        check_holes();
    }

    void check_borders() {
        for (const auto& [place, n] : by_place_) {
            check_sources(n);
            for (const auto& [di, dj] : {Coordinate{1, 0}, Coordinate{0, 1}, Coordinate{1, 1}, Coordinate{1, -1}}) {
                const auto neighbour = by_place_.find({place.first + di, place.second + dj});
                if (neighbour == by_place_.end()) continue;
                check_distance(n, neighbour->second);
                if (di != 0 && dj != 0) continue;
                check_sections(n, neighbour->second);
                check_step(n, neighbour->second, di != 0 ? 0 : 1);
            }
        }
    }

    std::vector<RegionFinding> take() {
        const auto order = [](const RegionFinding& f) { return std::tuple(f.sector, std::ranges::find(all_issues(), f.finding.issue) - all_issues().begin()); };
        std::ranges::stable_sort(found_, {}, order);
        return std::move(found_);
    }

  private:
    void add(std::size_t n, const Issue& issue, std::uint64_t offset, std::optional<double> value, std::string message, std::string path = "") {
        found_.push_back({n, {&issue, offset, std::move(path), value, std::move(message)}});
    }

    // Empty places that no way over empty places leads out of. Reported once, at the sector to their west.
    void check_holes() {
        if (by_place_.empty()) return;
        Coordinate low = by_place_.begin()->first, high = low;
        for (const auto& [place, n] : by_place_) {
            low = {std::min(low.first, place.first), std::min(low.second, place.second)};
            high = {std::max(high.first, place.first), std::max(high.second, place.second)};
        }
        // Only what may be a hole is walked, from an empty place with a sector to its west. The largest that n sectors can go round is a
        // diamond of n^2 / 8.
        const std::size_t most = std::min(by_place_.size() * by_place_.size() / 8 + 1, most_walked);
        std::set<Coordinate> known;
        for (const auto& [place, n] : by_place_) {
            const Coordinate start{place.first + 1, place.second};
            if (by_place_.contains(start) || known.contains(start)) continue;
            std::vector<Coordinate> hole = {start};
            std::set<Coordinate> seen = {start};
            bool open = false;
            for (std::size_t k = 0; k < hole.size() && !open; ++k) {
                open = hole.size() > most;
                for (const auto& [di, dj] : {Coordinate{1, 0}, Coordinate{-1, 0}, Coordinate{0, 1}, Coordinate{0, -1}}) {
                    const Coordinate next{hole[k].first + di, hole[k].second + dj};
                    open = open || next.first < low.first || next.first > high.first || next.second < low.second || next.second > high.second || outside_.contains(next);
                    if (!open && !by_place_.contains(next) && seen.insert(next).second) hole.push_back(next);
                }
            }
            (open ? outside_ : known).insert(seen.begin(), seen.end());
            if (!open) {
                add(n, issue::set_hole, layout::header::sector_i, static_cast<double>(hole.size()),
                    "sector " + text(start) + " to its east is missing" + (hole.size() == 1 ? "" : " with " + std::to_string(hole.size() - 1) + " more beside it") + ", and sectors are all around");
            }
        }
    }

    void check_sources(std::size_t n) {
        const RegionSector& sector = sectors_[n];
        for (std::size_t s = 0; s < sector.local_sources.size(); ++s) {
            const LocalSource& source = sector.local_sources[s];
            const auto neighbour = by_place_.find({sector.i + source.di, sector.j + source.dj});
            if (neighbour == by_place_.end()) continue;
            const std::size_t probes = sectors_[neighbour->second].positions.size();
            if (source.probe < probes) continue;
            const std::uint64_t offset = sector.local_offset + (sector.local_raw ? layout::LocalTransferLayout::source_at(s) : 0);
            add(n, issue::neighbour_source, offset, source.probe, "is probe " + std::to_string(source.probe) + " of sector " + text(neighbour->first) + ", which has " + std::to_string(probes),
                "local_transfer.sources" + index(s));
        }
    }

    void check_distance(std::size_t n, std::size_t other) {
        const RegionSector &a = sectors_[n], &b = sectors_[other];
        // Heights are rounded to steps, so that a distance may have lost one of each.
        const double least_units = static_cast<double>(std::min(a.bake.min_distance_m, b.bake.min_distance_m)) * position_units_per_m - a.position_step_units - b.position_step_units;
        for (std::size_t p = 0; p < a.positions.size(); ++p) {
            if (a.kinds[p] == ProbeKind::manual) continue;
            for (std::size_t q = 0; q < b.positions.size(); ++q) {
                if (b.kinds[q] == ProbeKind::manual) continue;
                double squared = 0;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const double d = static_cast<double>(a.positions[p][axis]) - static_cast<double>(b.positions[q][axis]);
                    squared += d * d;
                }
                if (squared >= least_units * least_units || least_units <= 0) continue;
                const double distance_m = std::sqrt(squared) / position_units_per_m;
                add(n, issue::neighbour_distance, 0, distance_m,
                    "stands " + std::to_string(distance_m) + " m from probe " + std::to_string(q) + " of sector " + text({b.i, b.j}) + ", and the minimal distance is " + std::to_string(std::min(a.bake.min_distance_m, b.bake.min_distance_m)) + " m",
                    probe_path(p) + ".position");
                return;  // one a border says it
            }
        }
    }

    void check_sections(std::size_t n, std::size_t other) {
        const RegionSector &a = sectors_[n], &b = sectors_[other];
        if (a.has_local_transfer == b.has_local_transfer || a.positions.empty() || b.positions.empty()) return;
        add(a.has_local_transfer ? other : n, issue::neighbour_sections, 0, std::nullopt, "has no local transfer, and its neighbour " + text(a.has_local_transfer ? Coordinate{a.i, a.j} : Coordinate{b.i, b.j}) + " has");
    }

    void check_step(std::size_t n, std::size_t other, std::size_t axis) {
        const BorderStep step = border_step(sectors_[n], sectors_[other], axis);
        if (!(step.across > most_step_ratio * step.inside && step.across > least_step)) return;
        add(n, issue::neighbour_step, 0, step.across,
            "towards sector " + text({sectors_[other].i, sectors_[other].j}) + " light steps by " + std::to_string(step.across) + " on average, inside the two by " + std::to_string(step.inside));
    }

    std::span<const RegionSector> sectors_;
    std::map<Coordinate, std::size_t> by_place_;
    std::set<Coordinate> outside_;
    std::vector<RegionFinding> found_;
};

}  // namespace

ReadStatus read_region_sector(std::span<const std::uint8_t> bytes, RegionSector& sector) {
    Sector read;
    SectionTable table;
    if (ReadStatus status = read_sector(bytes, read); !status.ok()) return status;
    if (ReadStatus status = load_section_table(bytes, table); !status.ok()) return status;
    RegionSector region;
    region.i = read.i;
    region.j = read.j;
    region.named = sector.named;
    region.bake = read.bake;
    region.position_step_units = 1 << read.z_shift;
    for (const Probe& probe : read.probes) {
        region.positions.push_back(position_units(read, probe));
        region.kinds.push_back(probe.kind);
        region.light.push_back(light_under_white_sky(probe));
    }
    region.grid = read.grid;
    region.has_local_transfer = read.local_transfer.has_value();
    if (read.local_transfer) region.local_sources = std::move(read.local_transfer->sources);
    if (const SectionEntry* entry = table.find(SectionKind::local_transfer)) {
        region.local_offset = entry->offset;
        region.local_raw = entry->codec == static_cast<std::uint8_t>(Codec::raw);
    }
    sector = std::move(region);
    return {};
}

std::vector<RegionFinding> validate_region(std::span<const RegionSector> sectors) {
    if (sectors.empty()) return {};
    Region region(sectors);
    region.check_set();
    region.check_borders();
    return region.take();
}

}  // namespace drtv
