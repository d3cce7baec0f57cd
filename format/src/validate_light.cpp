// Rules for static irradiance, local transfer and convergence.
#include "validate_rules.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;

constexpr int static_exponent_limit = 64;
constexpr int least_local_exponent = -126, greatest_local_exponent = 63;

// Light that is nowhere negative has |L_i| <= sqrt(3) L_0, and E/pi takes 2/3 of band 1: (2/3) sqrt(3)
// = 1.15470, here rounded up, in 1 / 10000. One code is for the rounding of both.
constexpr std::int64_t band1_over_band0 = 11548, one = 10000;

// Band 0 of a pair of probes there and back is one number, but for noise, rounding, what lies within the
// reach of one of the two only, and the light's inverse square, which is clamped near it and not near the
// receiver. Over a whole sector the sum of the differences is 0 to 2 % of the sum on real maps; up to 51 %
// where most probes stand 2 cm from a wall; 70 to 80 % where one side is that of other pairs. Few pairs prove
// nothing.
constexpr double most_asymmetry = 0.6;
constexpr std::size_t least_mutual_pairs = 16;

struct CodesAt {
    const layout::Place& place;
    std::uint64_t offset;
    bool largest_exponent;  // no larger scale could have been chosen
};

// Looks at each code of `codes`: reserved, saturated, and else `range(c, k)`, which gives a sentence where
// there is something to say.
template <class Path, class Range>
void check_codes(const LightCodes& codes,
                 const CodesAt& at,
                 const Issue& out_of_range,
                 Findings& findings,
                 Path path,
                 Range range) {
    std::uint64_t offset = at.offset;
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t k = 0; k < codes[c].size(); ++k, offset += sizeof(std::int16_t)) {
            const std::int16_t q = codes[c][k];
            const auto add = [&](const Issue& issue, const auto& sentence) {
                findings.add(
                    issue,
                    at.place.at(offset),
                    static_cast<double>(q),
                    [&] { return path() + "." + channel_name[c] + index(k); },
                    sentence);
            };
            if (q == INT16_MIN) {
                add(issue::fixed_point_reserved, [] { return std::string("code -32768 is reserved"); });
                continue;
            }
            if (at.largest_exponent && std::abs(q) == INT16_MAX)
                add(issue::fixed_point_saturated,
                    [&] { return "code " + std::to_string(q) + " under the largest exponent"; });
            if (const auto sentence = range(c, k))
                add(out_of_range, *sentence);
        }
    }
}

void check_sources(const LocalTransfer& local, const layout::Place& place, Findings& findings) {
    for (std::size_t s = 1; s < local.sources.size(); ++s) {
        for (std::size_t earlier = 0; earlier < s; ++earlier) {
            const LocalSource &a = local.sources[earlier], &b = local.sources[s];
            if (a.di != b.di || a.dj != b.dj || a.probe != b.probe)
                continue;
            findings.add(
                issue::local_source_duplicate,
                place.at(Local::source_at(s)),
                static_cast<double>(earlier),
                [&] { return "local_transfer.sources" + index(s); },
                [&] { return "is that of source " + std::to_string(earlier); });
            break;
        }
    }
}

// Gives a function that makes the sentence, where the code is out of its range.
auto local_range(const LightCodes& codes) {
    return [&codes](std::size_t c, std::size_t i) {
        const std::int64_t q = codes[c][i], q0 = codes[c][0];
        // What band 0 is not good for says nothing about band 1.
        const bool broken = i == 0 ? q < 0 : q0 >= 0 && one * std::abs(q) > band1_over_band0 * q0 + one;
        const auto sentence = [q, q0, i] {
            return "code " + std::to_string(q) +
                   (i == 0 ? " is negative"
                           : " is beyond 1.1548 times code " + std::to_string(q0) + " of band 0");
        };
        return broken ? std::optional(sentence) : std::nullopt;
    };
}

// Sums over all pairs of the sector's own probes that stand in both rows.
void check_reciprocity(const LocalTransfer& local, const layout::Place& place, Findings& findings) {
    const std::size_t count = local.receivers.size();
    std::vector<std::optional<Float3>> band0(count * count);  // [receiver][source probe]
    for (std::size_t p = 0; p < count; ++p) {
        std::size_t pair = local.receivers[p].first_pair;
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            if (!has_pair(local.receivers[p], s))
                continue;
            const LocalSource& source = local.sources[s];
            const LightCodes& codes = local.pairs[pair++];
            if (source.di != 0 || source.dj != 0)
                continue;
            const float scale = scale_of_exponent(local.receivers[p].exponent + source.exponent);
            Float3 values{};
            for (std::size_t c = 0; c < channel_count; ++c)
                values[c] = decode_fixed(codes[c][0], scale);
            band0[p * count + source.probe] = values;
        }
    }
    double differences = 0, sum = 0;
    std::size_t mutual = 0;
    for (std::size_t p = 0; p < count; ++p) {
        for (std::size_t q = 0; q < p; ++q) {
            const auto &there = band0[p * count + q], &back = band0[q * count + p];
            if (!there || !back)
                continue;
            ++mutual;
            for (std::size_t c = 0; c < channel_count; ++c) {
                differences += std::abs(static_cast<double>((*there)[c]) - static_cast<double>((*back)[c]));
                sum += static_cast<double>((*there)[c]) + static_cast<double>((*back)[c]);
            }
        }
    }
    if (mutual < least_mutual_pairs || !(differences > most_asymmetry * sum))
        return;
    findings.add(
        issue::local_reciprocity,
        place.at(0),
        differences / sum,
        [] { return std::string("local_transfer"); },
        [&] {
            return "there and back, " + std::to_string(mutual) + " pairs of probes differ by " +
                   std::to_string(differences / sum) + " of their sum, more than 0.6";
        });
}

}  // namespace

void check_static_irradiance(const Sector& sector, const layout::Place& place, Findings& findings) {
    const std::vector<StaticIrradiance>& probes = sector.static_irradiance;
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const auto path = [&] { return probe_path(p) + ".static_irradiance"; };
        check_codes(probes[p].codes,
                    {place, p * layout::light_codes_bytes, probes[p].exponent == static_exponent_limit},
                    issue::static_irradiance_range,
                    findings,
                    path,
                    [&](std::size_t c, std::size_t b) {
                        const std::int16_t q = probes[p].codes[c][b];
                        const auto sentence = [q] { return "code " + std::to_string(q) + " is negative"; };
                        return q < 0 ? std::optional(sentence) : std::nullopt;
                    });
    }
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const int exponent = probes[p].exponent;
        if (std::abs(exponent) <= static_exponent_limit)
            continue;
        findings.add(
            issue::static_exponent,
            place.at(probes.size() * layout::light_codes_bytes + p),
            exponent,
            [&] { return probe_path(p) + ".static_irradiance.exponent"; },
            [&] { return std::to_string(exponent) + " is not between -64 and 64"; });
    }
}

void check_local_transfer(const Sector& sector, const layout::Place& place, Findings& findings) {
    if (!sector.local_transfer)
        return;
    const LocalTransfer& local = *sector.local_transfer;
    const Local parts(local.receivers.size(), local.sources.size(), local.pairs.size());
    check_sources(local, place, findings);
    for (std::size_t p = 0; p < local.receivers.size(); ++p) {
        const LocalReceiver& receiver = local.receivers[p];
        std::size_t sources = 0;
        for (std::uint8_t byte : receiver.sources)
            sources += static_cast<std::size_t>(std::popcount(byte));
        if (sources > max_local_sources) {
            findings.add(
                issue::local_source_count,
                place.at(parts.masks + p * Local::mask_bytes(local.sources.size())),
                static_cast<double>(sources),
                [&] { return probe_path(p) + ".local"; },
                [&] {
                    return "takes light from " + std::to_string(sources) + " sources, over the limit of 128";
                });
        }
        std::size_t pair = receiver.first_pair;
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            if (!has_pair(receiver, s))
                continue;
            const auto path = [&] { return probe_path(p) + ".local" + index(pair - receiver.first_pair); };
            const int sum = receiver.exponent + local.sources[s].exponent;
            if (sum < least_local_exponent || sum > greatest_local_exponent) {
                findings.add(issue::local_exponent, place.at(parts.receiver_at(p) + 4), sum, path, [&] {
                    return "exponents " + std::to_string(receiver.exponent) + " and " +
                           std::to_string(local.sources[s].exponent) + " add up to " + std::to_string(sum) +
                           ", not between -126 and 63";
                });
            }
            check_codes(local.pairs[pair],
                        {place, parts.pair_at(pair), sum == greatest_local_exponent},
                        issue::local_transfer_range,
                        findings,
                        path,
                        local_range(local.pairs[pair]));
            ++pair;
        }
    }
    check_reciprocity(local, place, findings);
}

void check_convergence(const Sector& sector, const layout::Place& place, Findings& findings) {
    if (!sector.convergence)
        return;
    const Convergence& c = *sector.convergence;
    const auto at_least =
        [&](const char* field, std::uint64_t offset, auto value, auto least, const char* least_name) {
            if (value >= least)
                return;
            findings.add(
                issue::convergence_range,
                place.at(offset),
                static_cast<double>(value),
                [&] { return std::string("convergence.") + field; },
                [&] { return std::to_string(value) + " is less than " + least_name; });
        };
    at_least("error_asked", 0, c.error_asked, 0.0f, "0");
    at_least("error_median", 4, c.error_median, 0.0f, "0");
    at_least("error_p95", 8, c.error_p95, c.error_median, "the median");
    at_least("error_max", 12, c.error_max, c.error_p95, "the 95th percentile");
    at_least("paths_most", 20, c.paths_most, c.paths_least, "the least");
}

}  // namespace drtv
