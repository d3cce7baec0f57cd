// Rules for settings and for what every probe has: position, sky visibility, transfer.
#include "sentence.h"
#include "validate_rules.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace drtv {
namespace {

// Under a sky of radiance 1. Both sums come from the same rays; what is over 1 is rounding of codes and
// weights.
constexpr float max_energy = 1.01f;
// Radiance that is nowhere negative has |L_i| <= sqrt(3) L_0; two codes for the rounding of both.
constexpr double sqrt3 = 1.7320508;
constexpr double band_slack_codes = 2;

// Where a code stands: probe, channel, basis direction, coefficient.
struct TransferCode {
    const SectionCheck& check;
    std::size_t p;
    std::size_t c;
    std::size_t b;
    std::size_t i;

    [[nodiscard]] const std::array<std::int16_t, sh_count>& codes() const {
        return check.sector.probes[p].transfer[c][b];
    }
    [[nodiscard]] std::uint64_t offset() const {
        const std::size_t before = (c * basis_count + b) * sh_count + i;
        return check.place.at(p * layout::transfer_bytes + 2 * before);
    }
    [[nodiscard]] std::string path() const {
        return probe_path(p) + ".transfer." + channel_name[c] + index(b) + index(i);
    }
    template <class Message>
    void add(const Issue& issue, double value, Message message) const {
        check.findings.add(
            issue, offset(), value, [&] { return path(); }, message);
    }
};

void check_transfer_code(const TransferCode& at) {
    const std::int16_t q = at.codes()[at.i];
    if (q == INT16_MIN) {
        at.add(issue::fixed_point_reserved, q, [] { return "code -32768 is reserved"; });
        return;
    }
    const float value = decode_fixed(q, transfer_scale);
    const float bound = at.i == 0 ? transfer_bound_y0 : transfer_bound_y1;
    if (std::abs(value) > bound) {
        at.add(issue::transfer_range, value, [&] { return sentence(value, " is beyond ", bound); });
        return;
    }
    // Y0 and Y2 are positive over the whole sky.
    const bool positive = at.i == 0 || at.i == 2;
    if (positive && q < 0) {
        at.add(issue::transfer_sign, value, [&] { return sentence(value, " is negative"); });
        return;
    }
    const std::int16_t q0 = at.codes()[0];
    if (at.i == 0 || q0 < 0)
        return;
    const double size = std::abs(q);
    if (size > sqrt3 * q0 + band_slack_codes) {
        at.add(issue::transfer_band, value, [&] {
            const float y0 = decode_fixed(q0, transfer_scale);
            return sentence(value, " is more than sqrt(3) times ", y0, " of Y0");
        });
    }
}

// What comes back from the ground and what is seen of the sky are at most all that the sky sends.
void check_energy(const SectionCheck& check, std::size_t p, std::size_t c, std::size_t b) {
    const Probe& probe = check.sector.probes[p];
    const float bounced = decode_fixed(probe.transfer[c][b][0], transfer_scale) / sh_y0;
    const float visibility = decode_fixed(probe.sky_visibility[b], sky_visibility_scale);
    const float seen = visibility * open_sky_share(b);
    if (!(bounced + seen > max_energy))
        return;
    // What is too large by itself is told already.
    if (bounced * sh_y0 > transfer_bound_y0)
        return;
    const TransferCode at{check, p, c, b, 0};
    at.add(issue::energy, bounced + seen, [&] {
        return sentence(
            "bounce ", bounced, " and sky ", seen, " under a sky of radiance 1 add up to more than 1");
    });
}

void check_visibility_code(const SectionCheck& check, std::size_t p, std::size_t b) {
    const std::int16_t q = check.sector.probes[p].sky_visibility[b];
    const bool down = b + 1 == basis_count;
    if (q == 0 || (q > 0 && !down))
        return;
    const std::uint64_t offset = check.place.at(p * layout::sky_visibility_bytes + 2 * b);
    const auto path = [&] { return probe_path(p) + ".sky_visibility" + index(b); };
    const auto add = [&](const Issue& issue, const char* what) {
        const auto message = [&] { return sentence("code ", q, what); };
        check.findings.add(issue, offset, q, path, message);
    };
    if (q == INT16_MIN)
        add(issue::fixed_point_reserved, " is reserved");
    else if (down)
        add(issue::sky_visibility_down, ", must be 0");
    else
        add(issue::sky_visibility_range, " is negative");
}

}  // namespace

void check_settings(const SectionCheck& check) {
    const auto check_positive = [&](const char* name, std::uint64_t offset, double value) {
        if (value > 0)
            return;
        const auto path = [&] { return std::string("settings.") + name; };
        const auto message = [] { return "is not above 0"; };
        check.findings.add(issue::settings_range, check.place.at(offset), value, path, message);
    };
    const BakeRecord& bake = check.sector.bake;
    check_positive("rays", layout::bake::rays, bake.rays);
    check_positive("reach", layout::bake::reach, static_cast<double>(bake.reach_m));
    check_positive("min_distance", layout::bake::min_distance, static_cast<double>(bake.min_distance_m));
}

void check_probe_positions(const SectionCheck& check) {
    const std::vector<Probe>& probes = check.sector.probes;
    for (std::size_t p = 1; p < probes.size(); ++p) {
        for (std::size_t q = 0; q < p; ++q) {
            if (probes[p].position != probes[q].position)
                continue;
            const std::uint64_t offset = check.place.at(p * layout::position::bytes);
            const auto path = [&] { return probe_path(p) + ".position"; };
            const auto message = [&] { return sentence("is that of probe ", q); };
            check.findings.add(issue::duplicate_position, offset, static_cast<double>(q), path, message);
            break;
        }
    }
}

void check_sky_visibility(const SectionCheck& check) {
    for (std::size_t p = 0; p < check.sector.probes.size(); ++p) {
        for (std::size_t b = 0; b < basis_count; ++b)
            check_visibility_code(check, p, b);
    }
}

void check_transfer(const SectionCheck& check) {
    for (std::size_t p = 0; p < check.sector.probes.size(); ++p) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                for (std::size_t i = 0; i < sh_count; ++i)
                    check_transfer_code({check, p, c, b, i});
            }
        }
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b)
                check_energy(check, p, c, b);
        }
    }
}

}  // namespace drtv
