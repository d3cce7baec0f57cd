// Lamps of the game on baked local transfer: what they bounce, as they stand and as they move.
#include "tests/ambient/baked_map.h"
#include "tests/ambient/scenes.h"
#include "tests/reference/reference_local.h"
#include "tests/reference/reference_random.h"

#include <drtv/local_lights.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace drtv::test {
namespace {

settings::BakeSettings with_local_transfer() {
    settings::BakeSettings settings;
    settings.rays = 64;
    settings.local_transfer = true;
    settings.local_bounces = 2;
    settings.local_rays = 1024;
    return settings;
}

struct Receiver {
    const LoadedSector* sector = nullptr;
    std::size_t probe = 0;
};

// Probes between two corners.
std::vector<Receiver> receivers_of(const BakedMap& map, const glm::vec3& low = glm::vec3(-1e9f),
                                   const glm::vec3& high = glm::vec3(1e9f)) {
    std::vector<Receiver> receivers;
    for (const LoadedSector* sector : map.sectors()) {
        for (std::size_t p = 0; p < sector->view.probe_count; ++p) {
            const Float3 at = position_m(sector->view, p);
            if (is_between({at[0], at[1], at[2]}, low, high))
                receivers.push_back({sector, p});
        }
    }
    return receivers;
}

// The receivers' basis colours, red alone.
std::vector<double> lit_by(const BakedMap& map, const std::vector<Receiver>& receivers,
                           const glm::dvec3& lamp) {
    std::array<LightShare, max_shares_per_light> shares;
    const std::size_t count =
        split_light(map.set(), {.position = {lamp.x, lamp.y, lamp.z}, .intensity = {1, 1, 1}}, shares);
    std::vector<double> all;
    for (const auto& [sector, probe] : receivers) {
        BasisColours colours{};
        LocalRelighter(*sector, {shares.data(), count}).add_to(colours, probe);
        for (const Float3& colour : colours)
            all.push_back(static_cast<double>(colour[0]));
    }
    return all;
}

// The same by path tracing, for each lamp.
std::vector<std::vector<double>> true_light(const BakedMap& map, const std::vector<Receiver>& receivers,
                                            const std::vector<glm::dvec3>& lamps) {
    const reference::Scene scene(map.map());
    std::vector<std::vector<double>> all(lamps.size());
    reference::LocalOptions options{.bounces = 2, .reach_m = 512, .batches = 2, .strata = 48};
    for (const auto& [sector, probe] : receivers) {
        const Float3 at = position_m(sector->view, probe);
        const auto estimates = reference::integrate_local(scene, {at[0], at[1], at[2]}, lamps, options);
        ++options.seed;
        for (std::size_t n = 0; n < lamps.size(); ++n) {
            for (const glm::dvec3& b : reference::basis) {
                const std::array<double, 4> y = {reference::y0, reference::y1 * b.y, reference::y1 * b.z,
                                                 reference::y1 * b.x};
                double colour = 0;
                for (std::size_t i = 0; i < y.size(); ++i)
                    colour += y[i] * estimates[n].transfer[0][i];
                all[n].push_back(colour);
            }
        }
    }
    return all;
}

struct Agreement {
    double error = 0;  // rms of the difference over that of the truth
    double sum = 0;    // found over true
};

Agreement agreement(const std::vector<double>& found, const std::vector<double>& truth) {
    double squares = 0, of_truth = 0, sum = 0, true_sum = 0;
    for (std::size_t n = 0; n < found.size(); ++n) {
        squares += std::pow(found[n] - truth[n], 2);
        of_truth += truth[n] * truth[n];
        sum += found[n];
        true_sum += truth[n];
    }
    return {std::sqrt(squares / of_truth), sum / true_sum};
}

// A mean over lamps at each height. The bounds are a tenth above what was measured (docs/measurements.md); no
// worse than 0.65, and a sum between 0.35 and 1.2, were asked for.
TEST(Lamps, OverAPlaneBounceAsMuchAsTheyShould) {
    const BakedMap map(plane_scene(glm::vec3(0.5f)).b, with_local_transfer(), {{0, 0}, {1, 0}});
    const auto receivers = receivers_of(map);
    struct Bound {
        double height_m;
        double error;
    };
    for (const auto& [height_m, largest_error] :
         {Bound{0.5, 0.6}, {1.0, 0.53}, {2.0, 0.45}, {4.0, 0.4}, {8.0, 0.44}}) {
        std::vector<glm::dvec3> lamps;
        reference::Random random(3);
        for (int n = 0; n < 24; ++n) {
            const double x = 16 + 96 * random.next();
            const double y = 16 + 32 * random.next();
            lamps.emplace_back(x, y, height_m);
        }
        const auto truth = true_light(map, receivers, lamps);
        double error = 0;
        std::vector<double> sums;
        for (std::size_t n = 0; n < lamps.size(); ++n) {
            const Agreement found = agreement(lit_by(map, receivers, lamps[n]), truth[n]);
            error += found.error / static_cast<double>(lamps.size());
            sums.push_back(found.sum);
        }
        std::ranges::sort(sums);
        const double median = sums[sums.size() / 2];
        std::printf("lamps %g m up: error %.2f, sum %.2f of the truth\n", height_m, error, median);
        EXPECT_LT(error, largest_error) << height_m;
        EXPECT_GT(median, 0.75) << height_m;
        EXPECT_LT(median, 1.0) << height_m;
    }
}

// A room keeps light that open ground loses, which the factor for a lamp's place does not know.
TEST(Lamps, InARoomBounceAboutAsMuchAsTheyShould) {
    const TwoRooms rooms = two_rooms({.shift_m = {0.3f, 0.7f, 0}});
    settings::BakeSettings settings = with_local_transfer();
    settings.min_distance_m = 2;
    const BakedMap map(rooms.source.b, settings, {{0, 0}});
    const auto receivers = receivers_of(map, rooms.west_low, rooms.west_high);
    ASSERT_GE(receivers.size(), 3u);
    std::vector<glm::dvec3> lamps;
    reference::Random random(5);
    const glm::dvec3 low = glm::dvec3(rooms.west_low) + 0.5;
    const glm::dvec3 size = glm::dvec3(rooms.west_high) - 0.5 - low;
    for (int n = 0; n < 32; ++n) {
        const double x = random.next();
        const double y = random.next();
        const double z = random.next();
        lamps.push_back(low + size * glm::dvec3(x, y, z));
    }
    const auto truth = true_light(map, receivers, lamps);
    double error = 0;
    double sum = 0;
    for (std::size_t n = 0; n < lamps.size(); ++n) {
        const Agreement found = agreement(lit_by(map, receivers, lamps[n]), truth[n]);
        error += found.error / static_cast<double>(lamps.size());
        sum += found.sum / static_cast<double>(lamps.size());
    }
    std::printf("lamps in a room of %zu probes: error %.2f, sum %.2f\n", receivers.size(), error, sum);
    EXPECT_LT(error, 0.5);
    EXPECT_NEAR(sum, 1, 0.2);
}

// From the middle of one sector to that of the next.
TEST(Lamps, MoveWithoutSteps) {
    const BakedMap map(plane_scene(glm::vec3(0.5f)).b, with_local_transfer(), {{0, 0}, {1, 0}});
    const auto receivers = receivers_of(map);
    constexpr double step_m = 0.04;
    constexpr double border_m = sector_size_m;
    constexpr double beside_border_m = 4;  // half a cell on each side, and a cell
    for (const double height_m : {0.5, 1.5, 4.0}) {
        double largest = 0, inside = 0, at_border = 0;
        std::vector<double> last;
        for (double x = 32; x < 96; x += step_m) {
            const std::vector<double> now = lit_by(map, receivers, {x, 30.3, height_m});
            double step = 0;
            for (std::size_t n = 0; n < now.size(); ++n) {
                largest = std::max(largest, now[n]);
                if (!last.empty())
                    step = std::max(step, std::abs(now[n] - last[n]));
            }
            double& of = std::abs(x - border_m) < beside_border_m ? at_border : inside;
            of = std::max(of, step);
            last = now;
        }
        std::printf("lamp %g m up, moved 4 cm: %.2f %% of the largest colour, at the border %.2f %%\n",
                    height_m, 100 * inside / largest, 100 * at_border / largest);
        EXPECT_LT(inside, 0.01 * largest) << height_m;
        EXPECT_LE(at_border, 1.05 * inside) << height_m;
    }
}

}  // namespace
}  // namespace drtv::test
