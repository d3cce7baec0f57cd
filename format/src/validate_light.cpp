// Rules for static irradiance, alone and of light groups; for convergence and quality.
#include "light_codes_rules.h"
#include "sentence.h"
#include "utf8.h"
#include "validate_rules.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace drtv {
namespace {

constexpr int max_exponent = 64;  // and -64 is the least

// Of codes that stand at `offset` in their section; `path` gives theirs.
template <class Path>
void check_codes(const StaticIrradiance& light, std::uint64_t offset, const SectionCheck& check, Path path) {
    const LightCodesAt at{
        check.place, offset, light.exponent == max_exponent, issue::static_irradiance_range};
    const auto range = [&](std::size_t c, std::size_t b) {
        const std::int16_t q = light.codes[c][b];
        const auto message = [q] { return sentence("code ", q, " is negative"); };
        return q < 0 ? std::optional(message) : std::nullopt;
    };
    check_light_codes(light.codes, at, check.findings, path, range);
}

// `at`: of the exponent, in the section. `light_path` gives that of the light.
template <class Path>
void check_exponent(int exponent, std::uint64_t at, const SectionCheck& check, Path light_path) {
    if (std::abs(exponent) <= max_exponent)
        return;
    const auto path = [&] { return light_path() + ".exponent"; };
    const auto message = [&] { return sentence(exponent, " is not between -64 and 64"); };
    check.findings.add(issue::static_exponent, check.place.at(at), exponent, path, message);
}

void check_name(const std::vector<LightGroup>& groups, std::size_t g, const SectionCheck& check) {
    const std::string& name = groups[g].name;
    const bool is_text = is_utf8(name);
    const bool in_order = g == 0 || groups[g - 1].name < name;
    if (is_text && in_order)
        return;
    const std::uint64_t offset = check.place.at(layout::LightGroupsLayout::name_at(g));
    const auto path = [&] { return "light_groups" + index(g); };
    const auto message = [&] {
        return is_text ? sentence("does not stand behind that of light group ", g - 1, " in order")
                       : std::string("is no UTF-8");
    };
    check.findings.add(issue::light_group_name, offset, std::nullopt, path, message);
}

}  // namespace

void check_static_irradiance(const SectionCheck& check) {
    const std::vector<StaticIrradiance>& probes = check.sector.static_irradiance;
    const auto path_of = [](std::size_t p) { return [p] { return probe_path(p) + ".static_irradiance"; }; };
    for (std::size_t p = 0; p < probes.size(); ++p)
        check_codes(probes[p], p * layout::light_codes_bytes, check, path_of(p));
    const std::size_t exponents = probes.size() * layout::light_codes_bytes;
    for (std::size_t p = 0; p < probes.size(); ++p)
        check_exponent(probes[p].exponent, exponents + p, check, path_of(p));
}

void check_light_groups(const SectionCheck& check) {
    const std::vector<LightGroup>& groups = check.sector.light_groups;
    const layout::LightGroupsLayout parts(check.sector.probes.size(), groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        check_name(groups, g, check);
        for (std::size_t p = 0; p < groups[g].irradiance.size(); ++p) {
            const StaticIrradiance& light = groups[g].irradiance[p];
            const auto path = [&] { return probe_path(p) + ".light_groups" + index(g); };
            check_codes(light, parts.codes_at(g, p), check, path);
            check_exponent(light.exponent, parts.exponent_at(g, p), check, path);
        }
    }
}

void check_quality(const SectionCheck& check) {
    if (!check.sector.quality)
        return;
    const Quality& quality = *check.sector.quality;
    const layout::QualityLayout parts(quality.probes.size(), quality.group_errors.size());
    // `at`: of the error, in the section.
    const auto check_error = [&](float error, std::uint64_t at, std::size_t p, const std::string& name) {
        if (error >= 0)
            return;
        const auto path = [&] { return probe_path(p) + ".quality." + name; };
        const auto message = [&] { return sentence(error, " is less than 0"); };
        const auto number = static_cast<double>(error);
        check.findings.add(issue::convergence_range, check.place.at(at), number, path, message);
    };
    for (std::size_t p = 0; p < quality.probes.size(); ++p) {
        const ProbeQuality& probe = quality.probes[p];
        const std::uint64_t at = parts.probe_at(p);
        check_error(probe.transfer_error, at + parts.transfer_error, p, "transfer_error");
        check_error(probe.visibility_error, at + parts.visibility_error, p, "visibility_error");
        check_error(probe.static_error, at + parts.static_error, p, "static_error");
    }
    for (std::size_t g = 0; g < quality.group_errors.size(); ++g) {
        for (std::size_t p = 0; p < quality.group_errors[g].size(); ++p) {
            const std::uint64_t at = parts.group_error_at(g, p);
            check_error(quality.group_errors[g][p], at, p, "group_errors" + index(g));
        }
    }
}

void check_convergence(const SectionCheck& check) {
    if (!check.sector.convergence)
        return;
    namespace field = layout::convergence;
    const Convergence& c = *check.sector.convergence;
    const auto at_least =
        [&](const char* field, std::uint64_t offset, auto value, auto least, const char* min_name) {
            if (value >= least)
                return;
            const auto path = [&] { return std::string("convergence.") + field; };
            const auto message = [&] { return sentence(value, " is less than ", min_name); };
            const auto number = static_cast<double>(value);
            check.findings.add(issue::convergence_range, check.place.at(offset), number, path, message);
        };
    at_least("error_asked", field::error_asked, c.error_asked, 0.0f, "0");
    at_least("error_median", field::error_median, c.error_median, 0.0f, "0");
    at_least("error_p95", field::error_p95, c.error_p95, c.error_median, "the median");
    at_least("error_max", field::error_max, c.error_max, c.error_p95, "the 95th percentile");
    at_least("paths_most", field::paths_most, c.paths_most, c.paths_least, "the least");
}

}  // namespace drtv
