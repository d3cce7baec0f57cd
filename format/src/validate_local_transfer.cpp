// Rules for local transfer.
#include "light_codes_rules.h"
#include "sentence.h"
#include "validate_rules.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;

constexpr int min_exponent = -126;
constexpr int max_exponent = 63;

// Light that is nowhere negative has |L_i| <= sqrt(3) L_0, and E/pi takes 2/3 of band 1: (2/3) sqrt(3)
// = 1.15470, here rounded up, in 1 / 10000. One code is for the rounding of both.
constexpr std::int64_t band1_over_band0 = 11548;
constexpr std::int64_t one = 10000;

// Band 0 of a pair of probes there and back is one number, but for noise, rounding, what lies within the
// reach of one of the two only, and the light's inverse square, which is clamped near it and not near the
// receiver. Over a whole sector the sum of the differences is 0 to 2 % of the sum on real maps; up to 51 %
// where most probes stand 2 cm from a wall; 70 to 80 % where one side is that of other pairs. Few pairs prove
// nothing.
constexpr double max_asymmetry = 0.6;
constexpr std::size_t min_mutual_pairs = 16;

bool is_same_place(const LocalSource& a, const LocalSource& b) {
    return a.di == b.di && a.dj == b.dj && a.probe == b.probe;
}

void check_sources(const std::vector<LocalSource>& sources, const SectionCheck& check) {
    for (std::size_t s = 1; s < sources.size(); ++s) {
        for (std::size_t earlier = 0; earlier < s; ++earlier) {
            if (!is_same_place(sources[earlier], sources[s]))
                continue;
            const std::uint64_t offset = check.place.at(Local::source_at(s));
            const auto path = [&] { return "local_transfer.sources" + index(s); };
            const auto message = [&] { return sentence("is that of source ", earlier); };
            const auto value = static_cast<double>(earlier);
            check.findings.add(issue::local_source_duplicate, offset, value, path, message);
            break;
        }
    }
}

// Gives a function that makes the sentence, where the code is out of its range.
auto range_of(const LightCodes& codes) {
    return [&codes](std::size_t c, std::size_t i) {
        const std::int64_t q = codes[c][i];
        const std::int64_t q0 = codes[c][0];
        const bool negative = i == 0 && q < 0;
        // What band 0 is not good for says nothing about band 1.
        const bool beyond = i > 0 && q0 >= 0 && one * std::abs(q) > band1_over_band0 * q0 + one;
        const auto message = [q, q0, negative] {
            return negative ? sentence("code ", q, " is negative")
                            : sentence("code ", q, " is beyond 1.1548 times code ", q0, " of band 0");
        };
        return negative || beyond ? std::optional(message) : std::nullopt;
    };
}

std::size_t count_sources(const LocalReceiver& receiver) {
    int count = 0;
    for (std::uint8_t byte : receiver.sources)
        count += std::popcount(byte);
    return static_cast<std::size_t>(count);
}

void check_receiver(const LocalTransfer& local, std::size_t p, const SectionCheck& check) {
    const LocalReceiver& receiver = local.receivers[p];
    const Local parts(local.receivers.size(), local.sources.size(), local.pairs.size());
    const std::size_t sources = count_sources(receiver);
    if (sources > max_local_sources) {
        const std::size_t mask_at = parts.masks + p * local_mask_bytes(local.sources.size());
        const auto path = [&] { return probe_path(p) + ".local"; };
        const auto message = [&] {
            return sentence("takes light from ", sources, " sources, over the limit of 128");
        };
        const auto value = static_cast<double>(sources);
        check.findings.add(issue::local_source_count, check.place.at(mask_at), value, path, message);
    }
    std::size_t pair = receiver.first_pair;
    for (std::size_t s = 0; s < local.sources.size(); ++s) {
        if (!has_pair(receiver, s))
            continue;
        const auto path = [&] { return probe_path(p) + ".local" + index(pair - receiver.first_pair); };
        const int exponent = local.sources[s].exponent;
        const int sum = receiver.exponent + exponent;
        if (sum < min_exponent || sum > max_exponent) {
            const std::uint64_t offset = check.place.at(parts.receiver_at(p) + Local::receiver_exponent);
            check.findings.add(issue::local_exponent, offset, sum, path, [&] {
                return sentence("exponents ",
                                receiver.exponent,
                                " and ",
                                exponent,
                                " add up to ",
                                sum,
                                ", not between -126 and 63");
            });
        }
        const LightCodes& codes = local.pairs[pair];
        const bool largest = sum == max_exponent;
        const LightCodesAt at{check.place, parts.pair_at(pair), largest, issue::local_transfer_range};
        check_light_codes(codes, at, check.findings, path, range_of(codes));
        ++pair;
    }
}

using Band0 = std::array<double, channel_count>;

// Of all pairs of the sector's own probes, [receiver][source probe].
std::vector<std::optional<Band0>> own_pairs(const LocalTransfer& local) {
    const std::size_t count = local.receivers.size();
    std::vector<std::optional<Band0>> pairs(count * count);
    for (std::size_t p = 0; p < count; ++p) {
        const LocalReceiver& receiver = local.receivers[p];
        std::size_t pair = receiver.first_pair;
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            if (!has_pair(receiver, s))
                continue;
            const LocalSource& source = local.sources[s];
            const LightCodes& codes = local.pairs[pair++];
            if (source.di != 0 || source.dj != 0)
                continue;
            const float scale = scale_of_exponent(receiver.exponent + source.exponent);
            Band0& band0 = pairs[p * count + source.probe].emplace();
            for (std::size_t c = 0; c < channel_count; ++c)
                band0[c] = static_cast<double>(decode_fixed(codes[c][0], scale));
        }
    }
    return pairs;
}

// Over all pairs that stand in the rows of both probes.
struct Reciprocity {
    std::size_t mutual = 0;
    double differences = 0;
    double sum = 0;

    void add(const Band0& there, const Band0& back) {
        ++mutual;
        for (std::size_t c = 0; c < channel_count; ++c) {
            differences += std::abs(there[c] - back[c]);
            sum += there[c] + back[c];
        }
    }
};

Reciprocity reciprocity_of(const LocalTransfer& local) {
    const std::size_t count = local.receivers.size();
    const auto pairs = own_pairs(local);
    Reciprocity reciprocity;
    for (std::size_t p = 0; p < count; ++p) {
        for (std::size_t q = 0; q < p; ++q) {
            const auto& there = pairs[p * count + q];
            const auto& back = pairs[q * count + p];
            if (there && back)
                reciprocity.add(*there, *back);
        }
    }
    return reciprocity;
}

void check_reciprocity(const LocalTransfer& local, const SectionCheck& check) {
    const auto [mutual, differences, sum] = reciprocity_of(local);
    if (mutual < min_mutual_pairs || !(differences > max_asymmetry * sum))
        return;
    const double share = differences / sum;
    const auto path = [] { return "local_transfer"; };
    const std::string message = sentence(
        "there and back, ", mutual, " pairs of probes differ by ", share, " of their sum, more than 0.6");
    check.findings.add(issue::local_reciprocity, check.place.at(0), share, path, [&] { return message; });
}

}  // namespace

void check_local_transfer(const SectionCheck& check) {
    if (!check.sector.local_transfer)
        return;
    const LocalTransfer& local = *check.sector.local_transfer;
    check_sources(local.sources, check);
    for (std::size_t p = 0; p < local.receivers.size(); ++p)
        check_receiver(local, p, check);
    check_reciprocity(local, check);
}

}  // namespace drtv
