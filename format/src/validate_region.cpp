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

// On real maps the largest ratio is below 3; where it is dim the step must be one that can be seen. Few
// probes inside prove nothing.
constexpr double most_step_ratio = 4, least_step = 0.05;
constexpr std::size_t least_steps_inside = 64;

// Holes are looked for where the rectangle around sectors that touch has no more places than this: 131 x 131
// km.
constexpr std::size_t most_walked = std::size_t{1} << 22;

std::string text(const Coordinate& sector) {
    return "(" + std::to_string(sector.first) + ", " + std::to_string(sector.second) + ")";
}

class Region {
  public:
    Region(std::span<const RegionSector> sectors, std::span<const std::array<std::int32_t, 2>> also_there)
        : sectors_(sectors) {
        for (const auto& [i, j] : also_there)
            also_there_.insert({i, j});
        for (std::size_t n = 0; n < sectors.size(); ++n) {
            const auto [entry, added] = by_place_.try_emplace({sectors[n].i, sectors[n].j}, n);
            if (!added)
                add(n,
                    issue::set_duplicate,
                    layout::header::sector_i,
                    std::nullopt,
                    "sector " + text(entry->first) + " is in another file of the set too");
        }
    }

    void check_set() {
        std::map<std::array<std::uint8_t, 32>, std::size_t> keys;
        for (const RegionSector& sector : sectors_)
            ++keys[sector.bake.settings_key];
        const auto most = std::ranges::max_element(keys, {}, [](const auto& key) { return key.second; });
        for (std::size_t n = 0; n < sectors_.size(); ++n) {
            const RegionSector& sector = sectors_[n];
            if (sector.bake.settings_key != most->first) {
                add(n,
                    issue::set_settings,
                    0,
                    std::nullopt,
                    "was baked with other settings than " + std::to_string(most->second) + " of the " +
                        std::to_string(sectors_.size()) + " sectors",
                    "settings.key");
            }
            if (sector.named && *sector.named != std::array{sector.i, sector.j}) {
                add(n,
                    issue::set_file_name,
                    layout::header::sector_i,
                    std::nullopt,
                    "the file is named for sector " + text({(*sector.named)[0], (*sector.named)[1]}) +
                        " and holds sector " + text({sector.i, sector.j}));
            }
        }
        check_holes();
    }

    void check_borders() {
        for (const auto& [place, n] : by_place_) {
            check_sources(n);
            for (const auto& [di, dj] :
                 {Coordinate{1, 0}, Coordinate{0, 1}, Coordinate{1, 1}, Coordinate{1, -1}}) {
                const auto neighbour = by_place_.find({place.first + di, place.second + dj});
                if (neighbour == by_place_.end())
                    continue;
                check_distance(n, neighbour->second);
                if (di != 0 && dj != 0)
                    continue;
                check_sections(n, neighbour->second);
                check_step(n, neighbour->second, di != 0 ? 0 : 1);
            }
        }
    }

    std::vector<RegionFinding> take() {
        const auto order = [](const RegionFinding& f) {
            return std::tuple(f.sector,
                              std::ranges::find(all_issues(), f.finding.issue) - all_issues().begin());
        };
        std::ranges::stable_sort(found_, {}, order);
        return std::move(found_);
    }

  private:
    void add(std::size_t n,
             const Issue& issue,
             std::uint64_t offset,
             std::optional<double> value,
             std::string message,
             std::string path = "") {
        found_.push_back({n, {&issue, offset, std::move(path), value, std::move(message)}});
    }

    [[nodiscard]] bool is_there(const Coordinate& place) const {
        return by_place_.contains(place) || also_there_.contains(place);
    }

    // The places of a component: sectors that touch, corners included. What goes round a hole is one.
    [[nodiscard]] std::vector<std::vector<Coordinate>> components() const {
        std::set<Coordinate> left = also_there_;
        for (const auto& [place, n] : by_place_)
            left.insert(place);
        std::vector<std::vector<Coordinate>> found;
        while (!left.empty()) {
            std::vector<Coordinate>& component = found.emplace_back(1, *left.begin());
            left.erase(left.begin());
            for (std::size_t k = 0; k < component.size(); ++k) {
                for (std::int32_t dj = -1; dj <= 1; ++dj) {
                    for (std::int32_t di = -1; di <= 1; ++di) {
                        const Coordinate next{component[k].first + di, component[k].second + dj};
                        if (left.erase(next) > 0)
                            component.push_back(next);
                    }
                }
            }
        }
        return found;
    }

    // Empty places that no way over empty places leads out of. Each hole is reported once.
    void check_holes() {
        std::set<Coordinate> known;
        for (const std::vector<Coordinate>& component : components()) {
            Coordinate low = component.front(), high = low;
            for (const Coordinate& place : component) {
                low = {std::min(low.first, place.first), std::min(low.second, place.second)};
                high = {std::max(high.first, place.first), std::max(high.second, place.second)};
            }
            // With a frame of one place around, from which all that is open can be reached.
            const auto width = static_cast<std::size_t>(high.first - low.first + 3),
                       height = static_cast<std::size_t>(high.second - low.second + 3);
            if (width * height > most_walked)
                continue;
            std::vector<bool> closed(width * height, true);
            const auto place_of = [&](std::size_t at) {
                return Coordinate{low.first - 1 + static_cast<std::int32_t>(at % width),
                                  low.second - 1 + static_cast<std::int32_t>(at / width)};
            };
            static_cast<void>(walk(0, width, height, closed, low));
            for (std::size_t at = 0; at < closed.size(); ++at) {
                const Coordinate place = place_of(at);
                if (!closed[at] || is_there(place) || known.contains(place))
                    continue;
                std::vector<std::size_t> hole = walk(at, width, height, closed, low);
                for (const std::size_t part : hole)
                    known.insert(place_of(part));
                report_hole(place, hole.size());
            }
        }
    }

    // All empty places that can be reached from `start`, side by side, within the rectangle; they are open
    // from then on.
    std::vector<std::size_t> walk(std::size_t start,
                                  std::size_t width,
                                  std::size_t height,
                                  std::vector<bool>& closed,
                                  const Coordinate& low) const {
        std::vector<std::size_t> reached = {start};
        closed[start] = false;
        for (std::size_t k = 0; k < reached.size(); ++k) {
            const std::size_t at = reached[k], x = at % width, y = at / width;
            const auto go = [&](bool inside, std::size_t next) {
                if (!inside || !closed[next])
                    return;
                if (is_there({low.first - 1 + static_cast<std::int32_t>(next % width),
                              low.second - 1 + static_cast<std::int32_t>(next / width)}))
                    return;
                closed[next] = false;
                reached.push_back(next);
            };
            go(x > 0, at - 1);
            go(x + 1 < width, at + 1);
            go(y > 0, at - width);
            go(y + 1 < height, at + width);
        }
        return reached;
    }

    // At the sector to the west of its first place, or to the south where that one cannot be read.
    void report_hole(const Coordinate& first, std::size_t size) {
        for (const auto& [di, dj, side] : {std::tuple(-1, 0, "east"), std::tuple(0, -1, "north")}) {
            const auto beside = by_place_.find({first.first + di, first.second + dj});
            if (beside == by_place_.end())
                continue;
            add(beside->second,
                issue::set_hole,
                layout::header::sector_i,
                static_cast<double>(size),
                "sector " + text(first) + " to its " + side + " is missing" +
                    (size == 1 ? "" : " with " + std::to_string(size - 1) + " more beside it") +
                    ", and sectors are all around");
            return;
        }
    }

    void check_sources(std::size_t n) {
        const RegionSector& sector = sectors_[n];
        for (std::size_t s = 0; s < sector.local_sources.size(); ++s) {
            const LocalSource& source = sector.local_sources[s];
            const auto neighbour = by_place_.find({sector.i + source.di, sector.j + source.dj});
            if (neighbour == by_place_.end())
                continue;
            const std::size_t probes = sectors_[neighbour->second].positions.size();
            if (source.probe < probes)
                continue;
            const std::uint64_t offset =
                sector.local_offset + (sector.local_raw ? layout::LocalTransferLayout::source_at(s) : 0);
            add(n,
                issue::neighbour_source,
                offset,
                source.probe,
                "is probe " + std::to_string(source.probe) + " of sector " + text(neighbour->first) +
                    ", which has " + std::to_string(probes),
                "local_transfer.sources" + index(s));
        }
    }

    void check_distance(std::size_t n, std::size_t other) {
        const RegionSector &a = sectors_[n], &b = sectors_[other];
        // Heights are rounded to steps, so that a distance may have lost one of each.
        const double least_units =
            static_cast<double>(std::min(a.bake.min_distance_m, b.bake.min_distance_m)) *
                position_units_per_m -
            a.position_step_units - b.position_step_units;
        for (std::size_t p = 0; p < a.positions.size(); ++p) {
            if (a.kinds[p] == ProbeKind::manual)
                continue;
            for (std::size_t q = 0; q < b.positions.size(); ++q) {
                if (b.kinds[q] == ProbeKind::manual)
                    continue;
                double squared = 0;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const double d =
                        static_cast<double>(a.positions[p][axis]) - static_cast<double>(b.positions[q][axis]);
                    squared += d * d;
                }
                if (squared >= least_units * least_units || least_units <= 0)
                    continue;
                const double distance_m = std::sqrt(squared) / position_units_per_m;
                add(n,
                    issue::neighbour_distance,
                    0,
                    distance_m,
                    "stands " + std::to_string(distance_m) + " m from probe " + std::to_string(q) +
                        " of sector " + text({b.i, b.j}) + ", and the minimal distance is " +
                        std::to_string(std::min(a.bake.min_distance_m, b.bake.min_distance_m)) + " m",
                    probe_path(p) + ".position");
                return;  // one a border says it
            }
        }
    }

    void check_sections(std::size_t n, std::size_t other) {
        const RegionSector &a = sectors_[n], &b = sectors_[other];
        if (a.has_local_transfer == b.has_local_transfer || a.positions.empty() || b.positions.empty())
            return;
        add(a.has_local_transfer ? other : n,
            issue::neighbour_sections,
            0,
            std::nullopt,
            "has no local transfer, and its neighbour " +
                text(a.has_local_transfer ? Coordinate{a.i, a.j} : Coordinate{b.i, b.j}) + " has");
    }

    void check_step(std::size_t n, std::size_t other, std::size_t axis) {
        const BorderStep step = border_step(sectors_[n], sectors_[other], axis);
        if (step.steps_inside < least_steps_inside ||
            !(step.across > most_step_ratio * step.inside && step.across > least_step))
            return;
        add(n,
            issue::neighbour_step,
            0,
            step.across,
            "towards sector " + text({sectors_[other].i, sectors_[other].j}) + " light steps by " +
                std::to_string(step.across) + " on average, inside the two by " +
                std::to_string(step.inside));
    }

    std::span<const RegionSector> sectors_;
    std::map<Coordinate, std::size_t> by_place_;
    std::set<Coordinate> also_there_;
    std::vector<RegionFinding> found_;
};

}  // namespace

ReadStatus read_region_sector(std::span<const std::uint8_t> bytes, RegionSector& sector) {
    Sector read;
    SectionTable table;
    if (ReadStatus status = read_sector(bytes, read); !status.ok())
        return status;
    if (ReadStatus status = load_section_table(bytes, table); !status.ok())
        return status;
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
    if (read.local_transfer)
        region.local_sources = std::move(read.local_transfer->sources);
    if (const SectionEntry* entry = table.find(SectionKind::local_transfer)) {
        region.local_offset = entry->offset;
        region.local_raw = entry->codec == static_cast<std::uint8_t>(Codec::raw);
    }
    sector = std::move(region);
    return {};
}

std::vector<RegionFinding> validate_region(std::span<const RegionSector> sectors,
                                           std::span<const std::array<std::int32_t, 2>> also_there) {
    if (sectors.empty())
        return {};
    Region region(sectors, also_there);
    region.check_set();
    region.check_borders();
    return region.take();
}

}  // namespace drtv
