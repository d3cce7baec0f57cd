#include "tests/reference/check_compare.h"

#include "tests/reference/in_parallel.h"
#include "tests/reference/reference_local.h"

#include <drtv/conventions.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>

namespace drtv::reference {
namespace {

constexpr std::uint32_t batches = 32, continuation_strata = 2;
constexpr const char* channel_names = "rgb";
constexpr std::array<const char*, 4> sh_names = {"Y0", "Y1", "Y2", "Y3"};

// All that one probe gives, by quantity.
struct ProbeResult {
    std::vector<Compared> visibility, statics;
    std::array<std::vector<Compared>, drtv::sh_count> transfer, local;
    std::vector<std::size_t> local_source;  // the probe from which each number of local[i] comes
};

Compared compared(std::int16_t code, float scale, double reference, double error, std::string name) {
    const double rounding = static_cast<double>(scale) / 32767 / std::sqrt(12.0);
    return {static_cast<double>(decode_fixed(code, scale)), reference, std::hypot(error, rounding), 0,
            std::move(name)};
}

// The product's noise in a number is judged against the mean of those around it.
void set_scale(std::vector<Compared>& numbers, std::size_t first, const std::vector<Compared>& of,
               std::size_t of_first) {
    double mean = 0;
    for (std::size_t n = of_first; n < of.size(); ++n)
        mean += std::abs(of[n].reference) / static_cast<double>(of.size() - of_first);
    for (std::size_t n = first; n < numbers.size(); ++n)
        numbers[n].scale = mean;
}

std::string indices(std::size_t c, std::size_t b) {
    return std::string(1, channel_names[c]) + "[" + std::to_string(b) + "]";
}

class Comparison {
  public:
    Comparison(const Sector& sector, const CheckSettings& settings) : sector_(sector), settings_(settings) {
        const std::size_t count = std::min(settings.probes, sector.probes.size());
        for (std::size_t n = 0; n < count; ++n)
            chosen_.push_back((2 * n + 1) * sector.probes.size() / (2 * count));
    }

    [[nodiscard]] const std::vector<std::size_t>& chosen() const { return chosen_; }

    [[nodiscard]] glm::dvec3 position(std::size_t probe) const {
        const auto units = position_units(sector_, sector_.probes[probe]);
        return glm::dvec3(units[0], units[1], units[2]) / static_cast<double>(position_units_per_m);
    }

    // What rays within reach of the chosen probes can meet.
    [[nodiscard]] Region region() const {
        Region region{glm::dvec3(std::numeric_limits<double>::infinity()),
                      glm::dvec3(-std::numeric_limits<double>::infinity())};
        for (const std::size_t probe : chosen_) {
            region.low = glm::min(region.low, position(probe) - reach());
            region.high = glm::max(region.high, position(probe) + reach());
        }
        return region;
    }

    [[nodiscard]] ProbeResult run(const Scene& scene, std::size_t probe) const {
        ProbeResult result;
        add_light(scene, probe, result);
        if (sector_.local_transfer && settings_.local > 0)
            add_local(scene, probe, result);
        return result;
    }

  private:
    [[nodiscard]] double reach() const { return static_cast<double>(sector_.bake.reach_m); }
    [[nodiscard]] std::uint64_t seed(std::size_t probe, std::uint64_t use) const {
        return settings_.seed << 20 | use << 16 | probe;
    }
    [[nodiscard]] std::uint32_t strata(std::uint64_t paths_a_stratum) const {
        return static_cast<std::uint32_t>(
            std::max(1.0, std::ceil(std::sqrt(static_cast<double>(settings_.paths) /
                                              static_cast<double>(paths_a_stratum)))));
    }

    void add_light(const Scene& scene, std::size_t number, ProbeResult& result) const {
        const Options options{.bounces = sector_.bake.bounces,
                              .reach_m = reach(),
                              .batches = batches,
                              .strata = strata(batches * continuation_strata * continuation_strata),
                              .continuation_strata = continuation_strata,
                              .seed = seed(number, 1)};
        const Estimate estimate = integrate(scene, position(number), options);
        const Probe& probe = sector_.probes[number];
        for (std::size_t b = 0; b < 3; ++b)
            result.visibility.push_back(compared(probe.sky_visibility[b], sky_visibility_scale,
                                                 estimate.sky_visibility[b], estimate.visibility_error[b],
                                                 "[" + std::to_string(b) + "]"));
        set_scale(result.visibility, 0, result.visibility, 0);
        for (std::size_t c = 0; c < drtv::channel_count; ++c) {
            const std::size_t first = c * drtv::basis_count;
            for (std::size_t b = 0; b < drtv::basis_count; ++b) {
                for (std::size_t i = 0; i < drtv::sh_count; ++i) {
                    result.transfer[i].push_back(compared(probe.transfer[c][b][i], transfer_scale,
                                                          estimate.transfer[c][b][i],
                                                          estimate.transfer_error[c][b][i], indices(c, b)));
                }
                if (sector_.static_irradiance.empty() && sector_.light_groups.empty())
                    continue;
                result.statics.push_back(
                    all_static(number, c, b, estimate.static_irradiance[c][b], estimate.static_error[c][b]));
            }
            for (auto& numbers : result.transfer)
                set_scale(numbers, first, result.transfer[0], first);
            if (!result.statics.empty())
                set_scale(result.statics, first, result.statics, first);
        }
    }

    // Of all light groups together: the reference knows none.
    [[nodiscard]] Compared all_static(std::size_t number, std::size_t c, std::size_t b, double reference,
                                      double error) const {
        Compared all{0, reference, error, 0, indices(c, b)};
        const auto add = [&](const StaticIrradiance& light) {
            const Compared part = compared(light.codes[c][b], scale_of_exponent(light.exponent), 0, 0, "");
            all.product += part.product;
            all.error = std::hypot(all.error, part.error);
        };
        if (!sector_.static_irradiance.empty())
            add(sector_.static_irradiance[number]);
        for (const drtv::LightGroup& group : sector_.light_groups)
            add(group.irradiance[number]);
        return all;
    }

    void add_local(const Scene& scene, std::size_t number, ProbeResult& result) const {
        const drtv::LocalTransfer& local = *sector_.local_transfer;
        const LocalReceiver& receiver = local.receivers[number];
        struct Pair {
            std::size_t source, index;
        };
        std::vector<Pair> pairs;
        std::size_t index = receiver.first_pair;
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            if (!has_pair(receiver, s))
                continue;
            if (local.sources[s].di == 0 && local.sources[s].dj == 0)
                pairs.push_back({s, index});
            ++index;
        }
        Random random(seed(number, 2));
        for (std::size_t n = 0; n < pairs.size(); ++n)
            std::swap(
                pairs[n],
                pairs[n + static_cast<std::size_t>(random.next() * static_cast<double>(pairs.size() - n))]);
        pairs.resize(std::min(pairs.size(), settings_.local));
        std::vector<glm::dvec3> sources;
        for (const Pair& pair : pairs)
            sources.push_back(position(local.sources[pair.source].probe));
        const std::uint32_t bounces =
            sector_.convergence ? std::max(1u, sector_.convergence->local_bounces) : 1;
        const auto estimates = integrate_local(scene, position(number), sources,
                                               {.bounces = bounces,
                                                .reach_m = reach(),
                                                .batches = batches,
                                                .strata = strata(batches),
                                                .seed = seed(number, 3)});
        for (std::size_t n = 0; n < pairs.size(); ++n) {
            const LocalSource& source = local.sources[pairs[n].source];
            const float scale = scale_of_exponent(receiver.exponent + source.exponent);
            for (std::size_t c = 0; c < drtv::channel_count; ++c) {
                const std::size_t first = result.local[0].size();
                for (std::size_t i = 0; i < drtv::sh_count; ++i) {
                    const std::string name = "at probe " + std::to_string(number) + " " + channel_names[c];
                    result.local[i].push_back(compared(local.pairs[pairs[n].index][c][i], scale,
                                                       estimates[n].transfer[c][i],
                                                       estimates[n].transfer_error[c][i], name));
                }
                result.local_source.push_back(source.probe);
                for (auto& numbers : result.local)
                    set_scale(numbers, first, result.local[0], first);
            }
        }
    }

    const Sector& sector_;
    const CheckSettings& settings_;
    std::vector<std::size_t> chosen_;
};

}  // namespace

std::vector<Quantity> compare(const map::Map& map, const Sector& sector, const CheckSettings& settings) {
    const Comparison comparison(sector, settings);
    const Scene scene(map, comparison.region());
    std::cerr << scene.triangle_count() << " triangles within reach\n";
    std::vector<ProbeResult> results(comparison.chosen().size());
    in_parallel(settings.threads, results.size(),
                [&](std::size_t n) { results[n] = comparison.run(scene, comparison.chosen()[n]); });

    std::vector<Quantity> quantities;
    const auto add = [&](const std::string& name, auto numbers_of) {
        Quantity quantity{name, {}, name != "S"};
        bool any = false;
        for (std::size_t n = 0; n < results.size(); ++n) {
            quantity.probes.push_back({comparison.position(comparison.chosen()[n]), comparison.chosen()[n],
                                       numbers_of(results[n])});
            any = any || !quantity.probes.back().numbers.empty();
        }
        if (any)
            quantities.push_back(std::move(quantity));
    };
    add("v", [](const ProbeResult& r) { return r.visibility; });
    for (std::size_t i = 0; i < drtv::sh_count; ++i)
        add(std::string("T ") + sh_names[i], [i](const ProbeResult& r) { return r.transfer[i]; });
    add("S", [](const ProbeResult& r) { return r.statics; });
    if (!sector.local_transfer || settings.local == 0)
        return quantities;
    // By source: its paths may well serve all receivers, so that these err together.
    for (std::size_t i = 0; i < drtv::sh_count; ++i) {
        std::map<std::size_t, ProbeFigures> by_source;
        for (const ProbeResult& result : results) {
            for (std::size_t n = 0; n < result.local[i].size(); ++n) {
                const std::size_t source = result.local_source[n];
                const auto [entry, added] =
                    by_source.try_emplace(source, ProbeFigures{comparison.position(source), source, {}});
                entry->second.numbers.push_back(result.local[i][n]);
            }
        }
        Quantity quantity{std::string("R ") + sh_names[i], {}, false};
        for (auto& [source, figures] : by_source)
            quantity.probes.push_back(std::move(figures));
        if (!quantity.probes.empty())
            quantities.push_back(std::move(quantity));
    }
    return quantities;
}

}  // namespace drtv::reference
