#include "validate_light.h"

#include <bit>
#include <cstdlib>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;

constexpr int static_exponent_limit = 64;
constexpr int least_local_exponent = -126, greatest_local_exponent = 63;

// Light that is nowhere negative has |L_i| <= sqrt(3) L_0, and E/pi takes 2/3 of band 1: (2/3) sqrt(3) = 1.15470, here
// rounded up, in 1 / 10000. One code is for the rounding of both.
constexpr std::int64_t band1_over_band0 = 11548, one = 10000;

// Adds a finding for each reserved code; for each other code, for which `range(c, k)` gives a sentence, that one.
template <class Range>
void check_codes(const LightCodes& codes, const layout::Place& place, std::uint64_t at, const std::string& path, IssueIndex issue,
                 Findings& findings, Range range) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t k = 0; k < codes[c].size(); ++k, at += sizeof(std::int16_t)) {
            const bool reserved = codes[c][k] == INT16_MIN;
            const std::string sentence = reserved ? "code -32768 is reserved" : range(c, k);
            if (!sentence.empty()) findings.add(reserved ? reserved_code : issue, place.at(at), path + channel_name[c] + index(k), sentence);
        }
    }
}

void check_sources(const LocalTransfer& local, const layout::Place& place, Findings& findings) {
    for (std::size_t s = 1; s < local.sources.size(); ++s) {
        for (std::size_t earlier = 0; earlier < s; ++earlier) {
            const LocalSource &a = local.sources[earlier], &b = local.sources[s];
            if (a.di != b.di || a.dj != b.dj || a.probe != b.probe) continue;
            findings.add(local_source_duplicate, place.at(Local::source_at(s)), "local_transfer.sources" + index(s), "is that of source " + std::to_string(earlier));
            break;
        }
    }
}

void check_pair(const LightCodes& codes, const layout::Place& place, std::uint64_t at, const std::string& path, Findings& findings) {
    check_codes(codes, place, at, path, local_transfer_range, findings, [&](std::size_t c, std::size_t i) -> std::string {
        const std::int64_t q = codes[c][i], q0 = codes[c][0];
        if (i == 0) return q < 0 ? "code " + std::to_string(q) + " is negative" : "";
        // What band 0 is not good for says nothing about band 1.
        if (q0 < 0 || one * std::abs(q) <= band1_over_band0 * q0 + one) return "";
        return "code " + std::to_string(q) + " is beyond 1.1548 times code " + std::to_string(q0) + " of band 0";
    });
}

}  // namespace

void check_static_irradiance(const Sector& sector, const layout::Place& place, Findings& findings) {
    const std::vector<StaticIrradiance>& probes = sector.static_irradiance;
    for (std::size_t p = 0; p < probes.size(); ++p) {
        check_codes(probes[p].codes, place, p * layout::light_codes_bytes, probe_path(p) + ".static_irradiance.", static_irradiance_range, findings,
                    [&](std::size_t c, std::size_t b) -> std::string {
                        const std::int16_t q = probes[p].codes[c][b];
                        return q < 0 ? "code " + std::to_string(q) + " is negative" : "";
                    });
    }
    for (std::size_t p = 0; p < probes.size(); ++p) {
        if (std::abs(probes[p].exponent) <= static_exponent_limit) continue;
        findings.add(static_exponent, place.at(probes.size() * layout::light_codes_bytes + p), probe_path(p) + ".static_irradiance.exponent",
                     std::to_string(probes[p].exponent) + " is not between -64 and 64");
    }
}

void check_local_transfer(const Sector& sector, const layout::Place& place, Findings& findings) {
    if (!sector.local_transfer) return;
    const LocalTransfer& local = *sector.local_transfer;
    const Local parts(local.receivers.size(), local.sources.size(), local.pairs.size());
    check_sources(local, place, findings);
    for (std::size_t p = 0; p < local.receivers.size(); ++p) {
        const LocalReceiver& receiver = local.receivers[p];
        const std::string path = probe_path(p) + ".local";
        std::size_t sources = 0;
        for (std::uint8_t byte : receiver.sources) sources += static_cast<std::size_t>(std::popcount(byte));
        if (sources > max_local_sources) {
            findings.add(local_source_count, place.at(parts.masks + p * Local::mask_bytes(local.sources.size())), path,
                         "takes light from " + std::to_string(sources) + " sources, over the limit of 128");
        }
        std::size_t pair = receiver.first_pair;
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            if (!has_pair(receiver, s)) continue;
            const std::string pair_path = path + index(pair - receiver.first_pair);
            if (const int sum = receiver.exponent + local.sources[s].exponent; sum < least_local_exponent || sum > greatest_local_exponent) {
                findings.add(local_exponent, place.at(parts.receiver_at(p) + 4), pair_path, "exponents " + std::to_string(receiver.exponent) + " and " +
                             std::to_string(local.sources[s].exponent) + " add up to " + std::to_string(sum) + ", not between -126 and 63");
            }
            check_pair(local.pairs[pair], place, parts.pair_at(pair), pair_path + ".", findings);
            ++pair;
        }
    }
}

void check_convergence(const Sector& sector, const layout::Place& place, Findings& findings) {
    if (!sector.convergence) return;
    const Convergence& c = *sector.convergence;
    const auto at_least = [&](const char* field, std::uint64_t offset, auto value, auto least, const char* least_name) {
        if (value >= least) return;
        findings.add(convergence_range, place.at(offset), std::string("convergence.") + field, std::to_string(value) + " is less than " + least_name);
    };
    at_least("error_asked", 0, c.error_asked, 0.0f, "0");
    at_least("error_median", 4, c.error_median, 0.0f, "0");
    at_least("error_p95", 8, c.error_p95, c.error_median, "the median");
    at_least("error_max", 12, c.error_max, c.error_p95, "the 95th percentile");
    at_least("paths_most", 20, c.paths_most, c.paths_least, "the least");
}

}  // namespace drtv
