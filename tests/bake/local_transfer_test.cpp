// Local transfer: closed forms, reciprocity, and what it must not do.
#include "bakerd/bake/local_transfer.h"
#include "bakerd/bake/sector_bake.h"
#include "bakerd/bake/sector_file.h"
#include "tests/bake/worlds.h"

#include <drtv/read.h>

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

#include <cmath>
#include <numbers>
#include <random>

namespace drtv::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double sampling = 0.02;  // four standard errors of 4,096 rays a source

bake::LocalLight local_at(bake::World& world, const std::vector<glm::vec3>& places, std::uint32_t rays,
                          std::uint32_t bounces = 2) {
    const trace::FloatMode float_mode;
    const auto scene = world.scene_for({0, 0}, 512);
    std::vector<glm::ivec3> units;
    for (const glm::vec3& place : places)
        units.emplace_back(glm::round(place * 1024.0f));
    return bake::integrate_local(*scene, units, all_pairs(places.size()),
                                 *world.samples(rays, bake::local_sample_dimensions(bounces)),
                                 {bounces, 512});
}

// Lamp and probe on one axis over an endless plane: band 0 and the axis of band 1 by one integral over the
// plane.
TEST(LocalTransfer, LampOverAPlane) {
    constexpr double albedo = 0.6;
    GltfBuilder b;
    b.place(ground(2000), "", b.add_material({.colour = {albedo, albedo / 2, 0, 1}}));
    const auto world = open_world(b);
    const std::array<double, 3> heights = {0.25, 1.5, 6};
    const bake::LocalLight light = local_at(*world, {{20, 20, 0.25f}, {20, 20, 1.5f}, {20, 20, 6}}, 4096);
    for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t q = 0; q < 3; ++q) {
            double mean = 0, down = 0;
            constexpr int steps = 200000;
            for (int n = 0; n < steps; ++n) {
                const double r = 300 * std::pow((n + 0.5) / steps, 2),
                             dr = 300 * 2 * (n + 0.5) / steps / steps;
                const double to_probe = r * r + heights[p] * heights[p],
                             to_lamp = r * r + heights[q] * heights[q];
                const double radiance =
                    albedo / pi * heights[q] / std::sqrt(to_lamp) / std::max(to_lamp, 0.25);
                const double solid = heights[p] / (to_probe * std::sqrt(to_probe)) * 2 * pi * r * dr;
                mean += radiance * solid;
                down += radiance * solid * heights[p] / std::sqrt(to_probe);
            }
            const bake::LocalCoefficients& found = light.pairs[p][q];
            EXPECT_NEAR(found[0][0], static_cast<double>(sh_y0) * mean,
                        sampling * static_cast<double>(sh_y0) * mean)
                << p << " " << q;
            EXPECT_NEAR(found[0][2], -static_cast<double>(sh_y1) * down * 2 / 3,
                        sampling * static_cast<double>(sh_y1) * down)
                << p << " " << q;
            EXPECT_NEAR(found[1][0], found[0][0] / 2, 1e-6);
            EXPECT_EQ(found[2][0], 0);
            EXPECT_NEAR(found[0][1], 0, sampling * static_cast<double>(sh_y1) * down);
        }
    }
}

// A ball with a lamp in its middle: the wall is equally bright, and after one more bounce too.
TEST(LocalTransfer, FurtherBouncesAreTheGeometricSeries) {
    constexpr double albedo = 0.5, half = 4;
    GltfBuilder b;
    b.place(room({-half, -half, -half}, {half, half, half}), "",
            b.add_material({.colour = {albedo, albedo, albedo, 1}}));
    const auto world = open_world(b);
    // Total light of the room: what the walls get is all that the lamp sends, then the albedo's share of it
    // again. In the middle of a cube the first bounce is the brightest, so that only the sum of all positions
    // tells; close enough.
    std::array<double, 4> sums{};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-3.5f, 3.5f);
    std::vector<glm::vec3> places;
    for (int n = 0; n < 60; ++n)
        places.emplace_back(place(random), place(random), place(random));
    for (std::uint32_t bounces = 1; bounces <= 4; ++bounces) {
        const bake::LocalLight light = local_at(*world, places, 128, bounces);
        for (const auto& of_receiver : light.pairs) {
            for (const bake::LocalCoefficients& pair : of_receiver)
                sums[bounces - 1] += static_cast<double>(pair[0][0]);
        }
    }
    const double first = sums[0], second = sums[1] - sums[0], third = sums[2] - sums[1],
                 fourth = sums[3] - sums[2];
    EXPECT_NEAR(third / second, albedo, 0.03);
    EXPECT_NEAR(fourth / third, albedo, 0.05);
    EXPECT_GT(second, 0.3 * first);
    EXPECT_LT(second, 0.55 * first);
}

TEST(LocalTransfer, PairsAreReciprocal) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-15, 15), size(0.5f, 3);
    GltfBuilder b;
    const int grey = b.add_material({.colour = {0.6f, 0.5f, 0.4f, 1}});
    b.place(ground(60), "", grey);
    for (int n = 0; n < 30; ++n) {
        const glm::vec3 low(place(random), 0, place(random));
        b.place(box(low, low + glm::vec3(size(random), 2 * size(random), size(random))), "", grey);
    }
    const auto world = open_world(b);
    std::vector<glm::vec3> places;
    for (int n = 0; n < 25; ++n)
        places.emplace_back(place(random), place(random), 7 + size(random));
    const bake::LocalLight light = local_at(*world, places, 256);
    double difference = 0, total = 0;
    for (std::size_t p = 0; p < places.size(); ++p) {
        for (std::size_t q = 0; q < p; ++q) {
            const double there = static_cast<double>(light.pairs[p][q][0][0]),
                         back = static_cast<double>(light.pairs[q][p][0][0]);
            difference += std::abs(there - back);
            total += there + back;
        }
    }
    // Both directions are made of the same paths: what is left is rounding.
    EXPECT_GT(total, 0);
    EXPECT_LT(difference / total, 1e-4);
}

TEST(LocalTransfer, ClosedRoomsExchangeNothing) {
    GltfBuilder b;
    const int grey = b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}});
    b.place(room({-4, 0, -3}, {0, 3, 3}), "", grey);
    b.place(room({0.2f, 0, -3}, {4, 3, 3}), "", grey);
    const auto world = open_world(b);
    const bake::LocalLight light =
        local_at(*world, {{-1, 0, 1}, {-3, 1, 2}, {0.3f, 0, 1}, {3, -1, 2}}, 1024, 4);
    for (std::size_t p = 0; p < 4; ++p) {
        for (std::size_t q = 0; q < 4; ++q) {
            if (p / 2 == q / 2) {
                EXPECT_GT(light.pairs[p][q][0][0], 0) << p << " " << q;
            } else {
                EXPECT_EQ(light.pairs[p][q], bake::LocalCoefficients{}) << p << " " << q;
            }
        }
    }
}

settings::BakeSettings settings_without_local() {
    settings::BakeSettings settings;
    settings.rays = 64;
    return settings;
}

TEST(LocalTransfer, EachReceiverHasItsNearestSources) {
    GltfBuilder b;
    b.place(ground(150), "", b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}}));
    const auto world = open_world(b);
    settings::BakeSettings settings = settings_without_local();
    settings.local_transfer = true;
    settings.local_rays = 16;
    auto baked = bake::bake_sector(*world, {0, 0}, settings);
    ASSERT_TRUE(baked) << baked.error();
    ASSERT_TRUE(baked->sector.local_transfer);
    const LocalTransfer& local = *baked->sector.local_transfer;
    ASSERT_EQ(baked->sector.probes.size(), 64u);
    for (std::size_t s = 0; s < local.sources.size(); ++s) {
        const bool own = local.sources[s].di == 0 && local.sources[s].dj == 0;
        EXPECT_EQ(own, s < 64) << s;
        if (own) {
            EXPECT_EQ(local.sources[s].probe, s);
        }
    }
    // Each of all around it that are nearer than what it leaves out; the probes stand 8 m apart.
    std::vector<glm::ivec3> places;
    for (std::int32_t dj = -1; dj <= 1; ++dj) {
        for (std::int32_t di = -1; di <= 1; ++di) {
            const auto other = bake::bake_sector(*world, {di, dj}, settings_without_local());
            ASSERT_TRUE(other);
            for (const placement::Position& position : other->positions)
                places.push_back(position);
        }
    }
    ASSERT_EQ(places.size(), 9u * 64);
    for (std::size_t p = 0; p < 64; ++p) {
        std::vector<float> distances;
        for (const glm::ivec3& place : places)
            distances.push_back(glm::distance(glm::vec3(baked->positions[p]), glm::vec3(place)));
        std::ranges::sort(distances);
        std::size_t pairs = 0;
        float farthest = 0;
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            if (!has_pair(local.receivers[p], s))
                continue;
            ++pairs;
            const LocalSource& source = local.sources[s];
            const std::size_t sector = static_cast<std::size_t>(3 * (source.dj + 1) + source.di + 1);
            const glm::ivec3 place = places[64 * sector + source.probe];
            farthest = std::max(farthest, glm::distance(glm::vec3(baked->positions[p]), glm::vec3(place)));
        }
        EXPECT_LE(pairs, 128u);
        EXPECT_GT(pairs, 120u) << p;
        EXPECT_LE(farthest, distances[127]) << p;
    }
    const auto bytes = bake::encode_sector(baked->sector, baked->warnings);
    ASSERT_TRUE(bytes) << bytes.error();
    Sector read;
    ASSERT_TRUE(read_sector(*bytes, read).ok());
    EXPECT_EQ(read, baked->sector);
    // Alone or among others, in any order, the neighbours' bytes are the same.
    const auto again = open_world(b);
    for (const map::SectorCoordinate other : {map::SectorCoordinate{-1, 0}, {1, 1}})
        ASSERT_TRUE(bake::bake_sector(*again, other, settings));
    EXPECT_EQ(bake::bake_sector(*again, {0, 0}, settings)->sector, baked->sector);
}

}  // namespace
}  // namespace drtv::test
