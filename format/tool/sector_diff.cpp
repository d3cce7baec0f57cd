// Long because each part of a sector is compared in its own way.
#include "sector_diff.h"

#include <drtv/relight.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace drtv::tool {
namespace {

std::string probe_path(std::size_t p) {
    return "probe[" + std::to_string(p) + "]";
}
std::string index(std::size_t n) {
    return "[" + std::to_string(n) + "]";
}
constexpr std::array<char, channel_count> channel_name = {'r', 'g', 'b'};

// A white sky of radiance 1, and what falls on a probe from it.
BasisColours relit_of(const Sector& sector, std::size_t p) {
    static const SceneLight white{.sky = constant_sky({1, 1, 1})};
    BasisColours colours = relight(sector.probes[p].transfer, sector.probes[p].sky_visibility, white);
    if (!sector.static_irradiance.empty())
        add_static_irradiance(colours, sector.static_irradiance[p]);
    for (const LightGroup& group : sector.light_groups)
        add_static_irradiance(colours, group.irradiance[p]);
    return colours;
}

std::vector<std::size_t> matches_of(const Sector& first, const Sector& second) {
    std::map<std::array<std::int32_t, 3>, std::size_t> places;
    for (std::size_t p = 0; p < first.probes.size(); ++p)
        places.try_emplace(position_units(first, first.probes[p]), p);
    std::vector<std::size_t> match;
    for (const Probe& probe : second.probes) {
        const auto found = places.find(position_units(second, probe));
        match.push_back(found == places.end() ? no_match : found->second);
    }
    return match;
}

double decode(std::int16_t code, float scale) {
    return static_cast<double>(decode_fixed(code, scale));
}

// 0 where there is none.
double static_light(const std::vector<StaticIrradiance>& probes,
                    std::size_t p,
                    std::size_t c,
                    std::size_t b) {
    if (probes.empty())
        return 0;
    const StaticIrradiance& light = probes[p];
    return decode(light.codes[c][b], scale_of_exponent(light.exponent));
}

const LightGroup* find_group(const Sector& sector, const std::string& name) {
    const auto group = std::ranges::find(sector.light_groups, name, &LightGroup::name);
    return group == sector.light_groups.end() ? nullptr : &*group;
}

// A light group as either sector has it; null where it has not.
struct GroupPair {
    std::string name;
    const LightGroup* first;
    const LightGroup* second;
};

// Of both sectors, by name.
std::vector<GroupPair> group_pairs(const Sector& first, const Sector& second) {
    std::set<std::string> names;
    for (const Sector* sector : {&first, &second}) {
        for (const LightGroup& group : sector->light_groups)
            names.insert(group.name);
    }
    std::vector<GroupPair> pairs;
    for (const std::string& name : names)
        pairs.push_back({name, find_group(first, name), find_group(second, name)});
    return pairs;
}

// 0 where the sector has no such group.
double group_light(const LightGroup* group, std::size_t p, std::size_t c, std::size_t b) {
    return group == nullptr ? 0 : static_light(group->irradiance, p, c, b);
}

class Differ {
  public:
    Differ(const Sector& first, const Sector& second)
        : first_(first), second_(second), groups_(group_pairs(first, second)) {}

    SectorDiff run() {
        match_probes();
        for (std::size_t p = 0; p < second_.probes.size(); ++p) {
            if (diff_.match[p] != no_match)
                diff_probe(p, diff_.match[p]);
            else
                diff_.pairs_added += local_pairs_of(second_, p).size();
        }
        for (const std::size_t p : diff_.removed)
            diff_.pairs_removed += local_pairs_of(first_, p).size();
        diff_grid();
        diff_.settings = first_.bake != second_.bake;
        diff_.statistics = first_.statistics != second_.statistics;
        diff_.convergence = first_.convergence != second_.convergence;
        diff_.interiors = first_.interiors != second_.interiors;
        diff_.quality = first_.quality != second_.quality;
        for (const GroupPair& group : groups_) {
            if (group.second == nullptr)
                diff_.groups_only_first.push_back(group.name);
            else if (group.first == nullptr)
                diff_.groups_only_second.push_back(group.name);
        }
        return std::move(diff_);
    }

  private:
    void match_probes() {
        diff_.match = matches_of(first_, second_);
        diff_.relit.resize(second_.probes.size(), 0);
        second_of_first_.assign(first_.probes.size(), no_match);
        for (std::size_t p = 0; p < second_.probes.size(); ++p) {
            if (diff_.match[p] == no_match)
                ++diff_.added;
            else
                second_of_first_[diff_.match[p]] = p;
        }
        for (std::size_t p = 0; p < first_.probes.size(); ++p) {
            if (second_of_first_[p] == no_match)
                diff_.removed.push_back(p);
        }
    }

    // `where` gives the path of the number, and is asked only where the two differ.
    template <class Where>
    void add(Quantity quantity, double difference, const Where& where) {
        const bool differs = difference != 0;
        probe_changed_ = probe_changed_ || differs;
        diff_.changes[quantity].add(difference, differs ? where() : std::string());
    }

    // Probe p of the second sector and its match in the first.
    void diff_probe(std::size_t p, std::size_t before) {
        const Probe& then = first_.probes[before];
        const Probe& now = second_.probes[p];
        probe_changed_ = then.kind != now.kind;
        for (std::size_t b = 0; b < basis_count; ++b) {
            diff_sky_visibility(p, b, then, now);
            for (std::size_t c = 0; c < channel_count; ++c) {
                diff_transfer(p, c, b, then, now);
                diff_static_irradiance(p, before, c, b);
                diff_light_groups(p, before, c, b);
            }
        }
        diff_local(p, before);
        diff_relit(p, before);
        diff_.changed += probe_changed_ ? 1 : 0;
    }

    void diff_sky_visibility(std::size_t p, std::size_t b, const Probe& then, const Probe& now) {
        const double before = decode(then.sky_visibility[b], sky_visibility_scale);
        const double after = decode(now.sky_visibility[b], sky_visibility_scale);
        add(sky_visibility, after - before, [&] { return probe_path(p) + ".sky_visibility" + index(b); });
    }

    void diff_transfer(std::size_t p, std::size_t c, std::size_t b, const Probe& then, const Probe& now) {
        for (std::size_t i = 0; i < sh_count; ++i) {
            const double before = decode(then.transfer[c][b][i], transfer_scale);
            const double after = decode(now.transfer[c][b][i], transfer_scale);
            add(transfer, after - before, [&] {
                return probe_path(p) + ".transfer." + channel_name[c] + index(b) + index(i);
            });
        }
    }

    void diff_static_irradiance(std::size_t p, std::size_t before, std::size_t c, std::size_t b) {
        const double difference = static_light(second_.static_irradiance, p, c, b) -
                                  static_light(first_.static_irradiance, before, c, b);
        add(static_irradiance, difference, [&] {
            return probe_path(p) + ".static_irradiance." + channel_name[c] + index(b);
        });
    }

    void diff_light_groups(std::size_t p, std::size_t before, std::size_t c, std::size_t b) {
        for (const GroupPair& group : groups_) {
            const double difference =
                group_light(group.second, p, c, b) - group_light(group.first, before, c, b);
            add(light_groups, difference, [&] {
                return probe_path(p) + ".light_groups[" + group.name + "]." + channel_name[c] + index(b);
            });
        }
    }

    void diff_local(std::size_t p, std::size_t before) {
        if (!first_.local_transfer && !second_.local_transfer)
            return;
        const LocalPairs then = local_pairs_of(first_, before, &second_of_first_);
        const LocalPairs now = local_pairs_of(second_, p);
        const Coefficients zero{};
        for (const auto& [source, coefficients] : now) {
            const auto found = then.find(source);
            const bool added = found == then.end();
            diff_.pairs_added += added ? 1 : 0;
            diff_pair(p, source, added ? zero : found->second, coefficients);
        }
        for (const auto& [source, coefficients] : then) {
            if (now.contains(source))
                continue;
            ++diff_.pairs_removed;
            diff_pair(p, source, coefficients, zero);
        }
    }

    void diff_pair(std::size_t p,
                   const PairSource& source,
                   const Coefficients& then,
                   const Coefficients& now) {
        const auto where = [&] { return probe_path(p) + ".local from " + text(source, second_); };
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t i = 0; i < sh_count; ++i)
                add(local_transfer, now[c][i] - then[c][i], where);
        }
    }

    void diff_relit(std::size_t p, std::size_t before) {
        const BasisColours now = relit_of(second_, p);
        const BasisColours then = relit_of(first_, before);
        double& largest = diff_.relit[p];
        for (std::size_t b = 0; b < basis_count; ++b) {
            for (std::size_t c = 0; c < channel_count; ++c) {
                const double difference = static_cast<double>(now[b][c]) - static_cast<double>(then[b][c]);
                largest = std::max(largest, std::abs(difference));
                add(relit, difference, [&] { return probe_path(p); });
            }
        }
    }

    // Cells that name other probes, both seen as probes of the second sector.
    void diff_grid() {
        const Grid& then = first_.grid;
        const Grid& now = second_.grid;
        const bool same_origin = then.z_origin_units == now.z_origin_units;
        const bool same_height = then.cell_height_units == now.cell_height_units;
        diff_.grid_place = !same_origin || !same_height;
        for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
            const std::uint8_t a = then.cells[cell];
            const std::uint8_t b = now.cells[cell];
            const bool none_then = a >= first_.probes.size();
            const bool none_now = b >= second_.probes.size();
            const bool same = none_then || none_now ? none_then == none_now : second_of_first_[a] == b;
            diff_.cells += same ? 0 : 1;
        }
    }

    const Sector& first_;
    const Sector& second_;
    const std::vector<GroupPair> groups_;
    std::vector<std::size_t> second_of_first_;
    bool probe_changed_ = false;
    SectorDiff diff_;
};

}  // namespace

void QuantityChange::add(double difference, const std::string& where) {
    ++count;
    squares += difference * difference;
    if (std::abs(difference) <= largest)
        return;
    largest = std::abs(difference);
    at = where;
}

void QuantityChange::merge(const QuantityChange& other, const std::string& prefix) {
    count += other.count;
    squares += other.squares;
    if (other.largest <= largest)
        return;
    largest = other.largest;
    at = prefix + other.at;
}

double QuantityChange::rms() const {
    return count == 0 ? 0 : std::sqrt(squares / static_cast<double>(count));
}

bool SectorDiff::equal() const {
    const bool same_probes = removed.empty() && added == 0 && changed == 0;
    const bool same_pairs = pairs_added == 0 && pairs_removed == 0;
    const bool same_grid = cells == 0 && !grid_place;
    const bool same_groups = groups_only_first.empty() && groups_only_second.empty();
    return same_groups && same_probes && same_pairs && same_grid && !settings && !statistics &&
           !convergence && !interiors && !quality;
}

SectorDiff diff_sectors(const Sector& first, const Sector& second) {
    return Differ(first, second).run();
}

}  // namespace drtv::tool
