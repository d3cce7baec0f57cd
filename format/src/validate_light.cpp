// Rules for static irradiance and convergence.
#include "light_codes_rules.h"
#include "sentence.h"
#include "validate_rules.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace drtv {
namespace {

constexpr int max_exponent = 64;  // and -64 is the least

void check_codes(const StaticIrradiance& light, std::size_t p, const SectionCheck& check) {
    const LightCodesAt at{check.place,
                          p * layout::light_codes_bytes,
                          light.exponent == max_exponent,
                          issue::static_irradiance_range};
    const auto path = [&] { return probe_path(p) + ".static_irradiance"; };
    const auto range = [&](std::size_t c, std::size_t b) {
        const std::int16_t q = light.codes[c][b];
        const auto message = [q] { return sentence("code ", q, " is negative"); };
        return q < 0 ? std::optional(message) : std::nullopt;
    };
    check_light_codes(light.codes, at, check.findings, path, range);
}

// `at`: of the exponent, in the section.
void check_exponent(int exponent, std::size_t p, std::uint64_t at, const SectionCheck& check) {
    if (std::abs(exponent) <= max_exponent)
        return;
    const auto path = [&] { return probe_path(p) + ".static_irradiance.exponent"; };
    const auto message = [&] { return sentence(exponent, " is not between -64 and 64"); };
    check.findings.add(issue::static_exponent, check.place.at(at), exponent, path, message);
}

}  // namespace

void check_static_irradiance(const SectionCheck& check) {
    const std::vector<StaticIrradiance>& probes = check.sector.static_irradiance;
    for (std::size_t p = 0; p < probes.size(); ++p)
        check_codes(probes[p], p, check);
    const std::size_t exponents = probes.size() * layout::light_codes_bytes;
    for (std::size_t p = 0; p < probes.size(); ++p)
        check_exponent(probes[p].exponent, p, exponents + p, check);
}

void check_convergence(const SectionCheck& check) {
    if (!check.sector.convergence)
        return;
    const Convergence& c = *check.sector.convergence;
    const auto at_least =
        [&](const char* field, std::uint64_t offset, auto value, auto least, const char* least_name) {
            if (value >= least)
                return;
            const auto path = [&] { return std::string("convergence.") + field; };
            const auto message = [&] { return sentence(value, " is less than ", least_name); };
            const auto number = static_cast<double>(value);
            check.findings.add(issue::convergence_range, check.place.at(offset), number, path, message);
        };
    at_least("error_asked", 0, c.error_asked, 0.0f, "0");
    at_least("error_median", 4, c.error_median, 0.0f, "0");
    at_least("error_p95", 8, c.error_p95, c.error_median, "the median");
    at_least("error_max", 12, c.error_max, c.error_p95, "the 95th percentile");
    at_least("paths_most", 20, c.paths_most, c.paths_least, "the least");
}

}  // namespace drtv
