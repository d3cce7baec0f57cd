// The comparison that reference_check makes: a file that tells the truth passes, one that lies a little does
// not.
#include "tests/reference/check_compare.h"
#include "tests/reference/gltf_builder.h"
#include "tests/reference/reference_local.h"

#include <drtv/conventions.h>

#include <gtest/gtest.h>

#include <cmath>

namespace drtv::reference {
namespace {

constexpr double limit = 0.002;
constexpr double file_error = 0.02;  // of the numbers below, which are as noisy as the reference
constexpr CheckSettings settings{.probes = 255, .paths = 20000, .seed = 5, .local = 8};
constexpr std::uint32_t bounces = 2;
constexpr double reach_m = 200;

// Ground, a wall and a lamp.
map::Map make_court() {
    GltfBuilder builder;
    Patch patch;
    patch.add_quad({0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0});
    patch.add_box({10, 30, 0}, {30, 31, 6});
    builder.place(builder.add_mesh(patch, builder.add_material({.base_colour = {0.6f, 0.5f, 0.4f, 1}})), {});
    builder.place_lamp({.colour = {1, 0.8f, 0.5f}, .intensity = 6830, .position = {20, 25, 4}});
    return builder.import();
}

// What the reference itself says of the court, in a file's numbers. Sources: probe 0, one of the sector to
// the east, probe 3; probe 0 gets no light from the last, probe 2 none of the neighbour's.
Sector honest_sector(const map::Map& map) {
    Sector sector;
    sector.bake.bounces = bounces;
    sector.bake.reach_m = static_cast<float>(reach_m);
    sector.local_transfer.emplace();
    sector.local_transfer->sources = {{0, 0, 0, -3}, {1, 0, 7, 4}, {0, 0, 3, -2}};
    sector.convergence.emplace();
    sector.convergence->local_bounces = bounces;
    const Scene scene(map);
    const std::array<glm::dvec3, 4> places = {glm::dvec3(12, 20, 2), {20, 15, 3}, {25, 33, 1.5}, {33, 28, 2}};
    const std::array<glm::dvec3, 2> sources = {places[0], places[3]};
    for (std::size_t p = 0; p < places.size(); ++p) {
        const Estimate estimate = integrate(
            scene, places[p], {.bounces = bounces, .reach_m = reach_m, .strata = 32, .seed = 100 + p});
        const auto local =
            integrate_local(scene, places[p], sources,
                            {.bounces = bounces, .reach_m = reach_m, .strata = 32, .seed = 200 + p});
        Probe probe;
        for (std::size_t k = 0; k < 3; ++k)
            probe.position[k] =
                static_cast<std::uint16_t>(places[p][static_cast<glm::length_t>(k)] * position_units_per_m);
        StaticIrradiance light{{}, 2};
        LocalReceiver receiver{static_cast<std::uint32_t>(sector.local_transfer->pairs.size()), -1, {}};
        std::array<LightCodes, 3> pairs{};
        for (std::size_t c = 0; c < drtv::channel_count; ++c) {
            for (std::size_t b = 0; b < drtv::basis_count; ++b) {
                for (std::size_t i = 0; i < drtv::sh_count; ++i)
                    probe.transfer[c][b][i] =
                        encode_fixed(static_cast<float>(estimate.transfer[c][b][i]), transfer_scale);
                light.codes[c][b] = encode_fixed(static_cast<float>(estimate.static_irradiance[c][b]), 4);
                pairs[0][c][b] = encode_fixed(static_cast<float>(local[0].transfer[c][b]), 0x1p-4f);
                pairs[1][c][b] = 1234;  // the neighbour's: nobody asks
                pairs[2][c][b] = encode_fixed(static_cast<float>(local[1].transfer[c][b]), 0x1p-3f);
            }
        }
        for (std::size_t b = 0; b < 3; ++b)
            probe.sky_visibility[b] =
                encode_fixed(static_cast<float>(estimate.sky_visibility[b]), sky_visibility_scale);
        receiver.sources.resize(local_mask_bytes(3));
        for (std::size_t s = 0; s < 3; ++s) {
            if ((p == 0 && s == 2) || (p == 2 && s == 1))
                continue;
            receiver.sources[0] = static_cast<std::uint8_t>(receiver.sources[0] | 1u << s);
            sector.local_transfer->pairs.push_back(pairs[s]);
        }
        sector.probes.push_back(probe);
        sector.static_irradiance.push_back(light);
        sector.local_transfer->receivers.push_back(receiver);
    }
    return sector;
}

class ReferenceCheck : public testing::Test {
  protected:
    // Names of the quantities that are off.
    std::string off_in(const Sector& sector) const {
        std::string names;
        for (const Quantity& quantity : compare(map_, sector, settings))
            names += off(figures_of(quantity.probes, file_error), limit) ? quantity.name + "," : "";
        return names;
    }
    const map::Map map_ = make_court();
    Sector sector_ = honest_sector(map_);
};

TEST_F(ReferenceCheck, HonestFilePassesInAllItsNumbers) {
    const auto quantities = compare(map_, sector_, settings);
    ASSERT_EQ(quantities.size(), 10u);
    const std::size_t numbers[] = {12, 48, 48, 48, 48, 48, 21, 21, 21, 21};
    for (std::size_t q = 0; q < quantities.size(); ++q) {
        SCOPED_TRACE(quantities[q].name);
        const Figures figures = figures_of(quantities[q].probes, file_error);
        EXPECT_EQ(figures.numbers, numbers[q]);
        EXPECT_FALSE(off(figures, limit)) << figures.systematic << " +- " << figures.systematic_error;
        EXPECT_LT(figures.chi_squared_both, 2);
        EXPECT_GT(figures.mean, 0);
    }
}

TEST_F(ReferenceCheck, FileThatLiesIsOff) {
    for (Probe& probe : sector_.probes)
        probe.sky_visibility[1] = static_cast<std::int16_t>(probe.sky_visibility[1] * 0.9);
    EXPECT_EQ(off_in(sector_), "v,");
    for (StaticIrradiance& light : sector_.static_irradiance)
        light.exponent = 3;
    EXPECT_EQ(off_in(sector_), "v,S,");
    sector_ = honest_sector(map_);
    sector_.bake.bounces = 1;
    EXPECT_EQ(off_in(sector_).find("T Y0,T Y2"), 0u) << off_in(sector_);
    sector_ = honest_sector(map_);
    ++sector_.local_transfer->sources[2].exponent;
    EXPECT_EQ(off_in(sector_).find("R Y0"), 0u) << off_in(sector_);
}

TEST_F(ReferenceCheck, LightGroupsCountTogether) {
    sector_.light_groups = {{"lanterns", sector_.static_irradiance}};
    EXPECT_EQ(off_in(sector_), "S,") << "twice the light";
    for (StaticIrradiance& light : sector_.static_irradiance)
        light.codes = {};
    EXPECT_EQ(off_in(sector_), "");
    sector_.static_irradiance.clear();
    EXPECT_EQ(off_in(sector_), "");
}

TEST(ReferenceCheckFigures, AreThoseOfASmallSum) {
    // Two probes, differences 1, 1 and 3, 3 on a mean of 20.
    const std::vector<ProbeFigures> probes = {{{}, 0, {{11, 10, 1, 10, ""}, {31, 30, 1, 10, ""}}},
                                              {{}, 1, {{23, 20, 1, 10, ""}, {23, 20, 1, 10, "worst"}}}};
    const Figures figures = figures_of(probes, 0.1), unknown = figures_of(probes, 0);
    EXPECT_EQ(figures.numbers, 4u);
    EXPECT_DOUBLE_EQ(figures.mean, 20);
    EXPECT_DOUBLE_EQ(figures.systematic, 2.0 / 20);
    EXPECT_GT(figures.error_by_spread,
              10.0 / 20);  // of the mean of 1 and 3 it is 1; but of two numbers, who knows
    EXPECT_DOUBLE_EQ(figures.error_by_noise, std::sqrt(2 * (4 + 4)) / 4 / 20);
    EXPECT_DOUBLE_EQ(figures.systematic_error, figures.error_by_noise);
    EXPECT_DOUBLE_EQ(unknown.systematic_error, figures.error_by_spread);
    EXPECT_DOUBLE_EQ(figures.rms, std::sqrt(5.0) / 20);
    EXPECT_DOUBLE_EQ(figures.reference_error, 1.0 / 20);
    EXPECT_DOUBLE_EQ(figures.chi_squared, 5);
    EXPECT_DOUBLE_EQ(figures.chi_squared_both, 2.5);
    EXPECT_EQ(figures.worst_probe, 1u);
    EXPECT_FALSE(off(figures, limit));  // 10 % +- 5 %
    const std::vector<ProbeFigures> dark = {{{}, 0, {{1, 0, 0, 0, ""}}}};
    EXPECT_TRUE(off(figures_of(dark, 0), limit));
}

}  // namespace
}  // namespace drtv::reference
