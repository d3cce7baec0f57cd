#include "sector_diff.h"

#include <drtv/relight.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

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
    static const DistantLight sky = constant_sky({1, 1, 1});
    BasisColours colours = relight(sector.probes[p], sky, {});
    if (!sector.static_irradiance.empty())
        add_static_irradiance(colours, sector.static_irradiance[p]);
    return colours;
}

std::vector<std::size_t> match_probes(const Sector& first, const Sector& second) {
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

// A source of local transfer: (di, dj, whether it is a probe of the first sector that the second has not, its
// index). Own probes have the second sector's numbers where it has them; those of neighbours are taken by
// their number, as the files say it.
using PairKey = std::tuple<int, int, bool, std::size_t>;
using Coefficients = std::array<std::array<double, sh_count>, channel_count>;

std::map<PairKey, Coefficients> pairs_of(const Sector& sector,
                                         std::size_t p,
                                         const std::vector<std::size_t>* own_index) {
    std::map<PairKey, Coefficients> pairs;
    if (!sector.local_transfer)
        return pairs;
    const LocalTransfer& local = *sector.local_transfer;
    std::size_t pair = local.receivers[p].first_pair;
    for (std::size_t s = 0; s < local.sources.size(); ++s) {
        if (!has_pair(local.receivers[p], s))
            continue;
        const LocalSource& source = local.sources[s];
        const bool own = source.di == 0 && source.dj == 0;
        const std::size_t renumbered =
            own && own_index != nullptr ? (*own_index)[source.probe] : source.probe;
        const bool gone = renumbered == no_match;
        const std::size_t probe = gone ? source.probe : renumbered;
        const float scale = scale_of_exponent(local.receivers[p].exponent + source.exponent);
        Coefficients& coefficients = pairs[{source.di, source.dj, gone, probe}];
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t i = 0; i < sh_count; ++i)
                coefficients[c][i] = static_cast<double>(decode_fixed(local.pairs[pair][c][i], scale));
        }
        ++pair;
    }
    return pairs;
}

class Differ {
  public:
    Differ(const Sector& first, const Sector& second) : first_(first), second_(second) {}

    SectorDiff run() {
        diff_.match = match_probes(first_, second_);
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
        for (std::size_t p = 0; p < second_.probes.size(); ++p) {
            if (diff_.match[p] != no_match)
                diff_probe(p, diff_.match[p]);
            else
                diff_.pairs_added += pairs_of(second_, p, nullptr).size();
        }
        for (const std::size_t p : diff_.removed)
            diff_.pairs_removed += pairs_of(first_, p, nullptr).size();
        diff_grid();
        diff_.settings = first_.bake != second_.bake;
        diff_.statistics = first_.statistics != second_.statistics;
        diff_.convergence = first_.convergence != second_.convergence;
        diff_.interiors = first_.interiors != second_.interiors;
        return std::move(diff_);
    }

  private:
    void diff_probe(std::size_t p, std::size_t before) {
        const Probe &a = first_.probes[before], &b = second_.probes[p];
        bool changed = a.kind != b.kind;
        const auto add = [&](Quantity quantity, double difference, const auto& where) {
            changed = changed || difference != 0;
            diff_.changes[quantity].add(difference, difference == 0 ? std::string() : where());
        };
        for (std::size_t n = 0; n < basis_count; ++n) {
            add(sky_visibility,
                static_cast<double>(decode_fixed(b.sky_visibility[n], sky_visibility_scale)) -
                    static_cast<double>(decode_fixed(a.sky_visibility[n], sky_visibility_scale)),
                [&] { return probe_path(p) + ".sky_visibility" + index(n); });
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i) {
                    add(transfer,
                        static_cast<double>(decode_fixed(b.transfer[c][n][i], transfer_scale)) -
                            static_cast<double>(decode_fixed(a.transfer[c][n][i], transfer_scale)),
                        [&] { return probe_path(p) + ".transfer." + channel_name[c] + index(n) + index(i); });
                }
                add(static_irradiance,
                    static_light(second_, p, c, n) - static_light(first_, before, c, n),
                    [&] { return probe_path(p) + ".static_irradiance." + channel_name[c] + index(n); });
            }
        }
        diff_local(p, before, add);
        const BasisColours now = relit_of(second_, p), then = relit_of(first_, before);
        for (std::size_t n = 0; n < basis_count; ++n) {
            for (std::size_t c = 0; c < channel_count; ++c) {
                const double difference = static_cast<double>(now[n][c]) - static_cast<double>(then[n][c]);
                diff_.relit[p] = std::max(diff_.relit[p], std::abs(difference));
                add(relit, difference, [&] { return probe_path(p); });
            }
        }
        diff_.changed += changed ? 1 : 0;
    }

    static double static_light(const Sector& sector, std::size_t p, std::size_t c, std::size_t b) {
        if (sector.static_irradiance.empty())
            return 0;
        const StaticIrradiance& light = sector.static_irradiance[p];
        return static_cast<double>(decode_fixed(light.codes[c][b], scale_of_exponent(light.exponent)));
    }

    template <class Add>
    void diff_local(std::size_t p, std::size_t before, const Add& add) {
        if (!first_.local_transfer && !second_.local_transfer)
            return;
        const auto then = pairs_of(first_, before, &second_of_first_), now = pairs_of(second_, p, nullptr);
        const Coefficients zero{};
        const auto compare = [&](const PairKey& key, const Coefficients& a, const Coefficients& b) {
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i) {
                    add(local_transfer, b[c][i] - a[c][i], [&] {
                        return probe_path(p) + ".local from " +
                               (std::get<2>(key) ? "the first's probe " : "probe ") +
                               std::to_string(std::get<3>(key)) + " of (" +
                               std::to_string(second_.i + std::get<0>(key)) + ", " +
                               std::to_string(second_.j + std::get<1>(key)) + ")";
                    });
                }
            }
        };
        for (const auto& [key, coefficients] : now) {
            const auto found = then.find(key);
            if (found == then.end())
                ++diff_.pairs_added;
            compare(key, found == then.end() ? zero : found->second, coefficients);
        }
        for (const auto& [key, coefficients] : then) {
            if (now.contains(key))
                continue;
            ++diff_.pairs_removed;
            compare(key, coefficients, zero);
        }
    }

    void diff_grid() {
        diff_.grid_place = first_.grid.z_origin_units != second_.grid.z_origin_units ||
                           first_.grid.cell_height_units != second_.grid.cell_height_units;
        for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
            const std::uint8_t a = first_.grid.cells[cell], b = second_.grid.cells[cell];
            const std::size_t then = a < first_.probes.size() ? second_of_first_[a] : no_match,
                              now = b < second_.probes.size() ? b : no_match;
            const bool both_none = a >= first_.probes.size() && b >= second_.probes.size();
            diff_.cells += both_none || (then == now && then != no_match) ? 0 : 1;
        }
    }

    const Sector &first_, &second_;
    std::vector<std::size_t> second_of_first_;
    SectorDiff diff_;
};

}  // namespace

void Change::add(double difference, const std::string& where) {
    ++count;
    squares += difference * difference;
    if (std::abs(difference) <= largest)
        return;
    largest = std::abs(difference);
    at = where;
}

void Change::merge(const Change& other, const std::string& prefix) {
    count += other.count;
    squares += other.squares;
    if (other.largest <= largest)
        return;
    largest = other.largest;
    at = prefix + other.at;
}

double Change::rms() const {
    return count == 0 ? 0 : std::sqrt(squares / static_cast<double>(count));
}

bool SectorDiff::equal() const {
    return removed.empty() && added == 0 && changed == 0 && cells == 0 && !settings && !statistics &&
           !convergence && !interiors && !grid_place && pairs_added == 0 && pairs_removed == 0;
}

SectorDiff diff_sectors(const Sector& first, const Sector& second) {
    return Differ(first, second).run();
}

}  // namespace drtv::tool
