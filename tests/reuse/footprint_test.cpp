// The record of what a sector depends on: nothing that a ray crosses is missing, and it survives being
// stored.
#include "bakerd/reuse/footprint_record.h"

#include "bakerd/reuse/footprint_recorder.h"
#include "bakerd/reuse/rebake.h"
#include "bakerd/reuse/record_bytes.h"
#include "tests/bake/ray_log.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

namespace drtv::test {
namespace {

TEST(WeightCode, RoundsUpFinelyWhereTolerancesLie) {
    EXPECT_EQ(reuse::weight_code(0), 0);
    EXPECT_EQ(reuse::weight_of_code(0), 0.0f);
    std::uint8_t before = 0;
    for (float weight = 0x1p-20f; weight < 2; weight *= 1.01f) {
        const std::uint8_t code = reuse::weight_code(weight);
        EXPECT_GE(code, before);
        EXPECT_LE(code, reuse::max_weight_code);
        if (weight <= 1) {
            EXPECT_GE(reuse::weight_of_code(code), weight);
        }
        if (weight >= 0x1p-12f && code < reuse::max_weight_code) {
            EXPECT_LE(reuse::weight_of_code(code), weight * (weight <= 0x1p-8f ? 1.42f : 2.01f));
        }
        before = code;
    }
    for (std::uint8_t code = 0; code < reuse::max_weight_code; ++code)
        EXPECT_EQ(reuse::weight_code(reuse::weight_of_code(code)), code);
}

TEST(FootprintGrid, CoversTheDistanceAndTheHeights) {
    for (const float distance_m : {10.0f, 560.0f, 8192.0f}) {
        for (const float top_m : {5.0f, 700.0f, 8192.0f}) {
            const reuse::FootprintGrid grid = reuse::footprint_grid({-3, 7}, distance_m, -20, top_m);
            EXPECT_LE(grid.low().x, -3 * 64 - distance_m);
            EXPECT_GE(grid.high().x, -2 * 64 + distance_m);
            EXPECT_LE(grid.low().y, 7 * 64 - distance_m);
            EXPECT_GE(grid.high().y, 8 * 64 + distance_m);
            EXPECT_LT(grid.low().z, -20);
            EXPECT_GT(grid.high().z, top_m);
            EXPECT_LE(grid.layers, 64);
            EXPECT_LE(grid.columns, 80);
            EXPECT_GE(2 * grid.layer_m, grid.cell_m);  // the recorder's points rise by one block at most
        }
    }
}

bake::Shares even(float share) {
    return {share, share, share, share};
}

// A probe there, in sector (0, 0).
glm::ivec3 in_quarter(std::size_t quarter) {
    const auto upper = [](std::size_t is_upper) { return is_upper != 0 ? 40 * 1024 : 8 * 1024; };
    return {upper(quarter & 1), upper(quarter >> 1), 0};
}

void record_segment(reuse::FootprintRecorder& recorder, const trace::Ray& ray, float length_m,
                    const bake::Shares& shares, std::uint32_t path) {
    const bake::PathSegment segment{ray, length_m, shares, path, false};
    recorder.record_segments({&segment, 1});
}

void record_shadow(reuse::FootprintRecorder& recorder, const trace::Ray& ray, const bake::Shares& shares) {
    const bake::ShadowRay shadow{ray, shares};
    recorder.record_shadow_rays({&shadow, 1});
}

// Whatever point of a ray is asked for, its cell is marked, and its block has the ray's weight, once. Rays as
// long as the grid goes, from below and above it too.
TEST(FootprintRecorder, NoPointOfARayIsMissing) {
    std::mt19937 random(5);
    for (const auto& [distance_m, length_m, top_m] :
         {std::tuple(200.0f, 90.0f, 40.0f), std::tuple(560.0f, 390.0f, 120.0f),
          std::tuple(1100.0f, 930.0f, 300.0f), std::tuple(2500.0f, 2330.0f, 90.0f)}) {
        const reuse::FootprintGrid grid = reuse::footprint_grid({0, 0}, distance_m, -10, top_m);
        std::uniform_real_distribution<float> place(-100, 160), height(grid.low().z - 20, grid.high().z + 20),
            along(0, 1), sphere(-1, 1);
        // Of distances; those of places are far smaller.
        const float rounding_m = 0.01f + length_m * 0x1p-18f;
        for (int n = 0; n < 400; ++n) {
            reuse::FootprintRecorders recorders({0, 0}, grid);
            reuse::FootprintRecorder& recorder = recorders.of_this_thread();
            const auto quarter = static_cast<std::size_t>(n) % reuse::quarter_count;
            recorder.begin_probe(in_quarter(quarter));
            glm::vec3 direction(sphere(random), sphere(random),
                                n % 3 == 0 ? 0.0f : sphere(random) * (n % 2 == 0 ? 1.0f : 0.2f));
            if (n % 7 == 0)
                direction = {0, 0, 1};
            if (n % 11 == 0)
                direction.x = 0;
            if (glm::length(direction) < 0.1f)
                continue;
            const trace::Ray ray{
                {place(random), place(random), height(random)}, glm::normalize(direction), length_m};
            if (n % 2 == 0)
                record_segment(recorder, ray, ray.far_m, even(0.01f), 3);
            else
                record_shadow(recorder, ray, even(0.01f));
            reuse::Footprint footprint;
            recorders.store(footprint);
            for (int k = 0; k < 300; ++k) {
                const glm::vec3 point = ray.origin + ray.direction * (ray.far_m * along(random));
                if (point.z <= grid.low().z + 0.1f || point.z >= grid.high().z - 0.1f)
                    continue;
                bool marked = false;
                for (const float dx : {-rounding_m, 0.0f, rounding_m}) {
                    for (const float dy : {-rounding_m, 0.0f, rounding_m}) {
                        for (const float dz : {-rounding_m, 0.0f, rounding_m}) {
                            const glm::ivec3 cell(
                                glm::floor((point + glm::vec3(dx, dy, dz) - grid.low()) /
                                           glm::vec3(grid.cell_m, grid.cell_m, grid.layer_m)));
                            if (cell.x < 0 || cell.y < 0 || cell.z < 0 || cell.x >= grid.columns ||
                                cell.y >= grid.rows || cell.z >= grid.layers)
                                continue;
                            const bool crossed =
                                (footprint.crossed[grid.column(cell.x, cell.y)] >> cell.z & 1u) != 0;
                            marked |= crossed && footprint.weight(grid.block(cell.x, cell.y, cell.z),
                                                                  quarter) == reuse::weight_code(0.01f);
                        }
                    }
                }
                EXPECT_TRUE(marked) << "ray " << n << " at " << point.x << " " << point.y << " " << point.z;
            }
        }
    }
}

TEST(FootprintRecorder, SharesAddUpInAProbeAndTheLargestOfAQuarterCounts) {
    const reuse::FootprintGrid grid = reuse::footprint_grid({0, 0}, 200, 0, 20);
    reuse::FootprintRecorders recorders({0, 0}, grid);
    reuse::FootprintRecorder& recorder = recorders.of_this_thread();
    const trace::Ray up{{32, 32, 5}, {0, 0, 1}, 2}, aside{{-64, 32, 5}, {0, 0, 1}, 2};
    recorder.begin_probe(in_quarter(3));
    for (std::uint32_t path = 0; path < 4; ++path) {
        record_segment(recorder, up, 2, even(0x1p-10f), path);
        record_segment(recorder, up, 2, even(0x1p-11f), path);  // its later part, through the same block
    }
    recorder.begin_probe(in_quarter(3));
    record_segment(recorder, up, 2, even(0x1p-9f), 0);
    record_shadow(recorder, up, even(0x1p-13f));
    recorder.begin_probe(in_quarter(1));
    record_segment(recorder, up, 2, even(0x1p-12f), 0);
    // Of another quarter: to each basis direction its own sum, however little or much.
    recorder.begin_probe(in_quarter(2));
    for (std::uint32_t path = 0; path < 8; ++path) {
        bake::Shares shares{};
        shares[path % shares.size()] = 0x1p-10f;
        record_segment(recorder, up, 2, shares, path);
    }
    record_shadow(recorder, aside, {0, 0, 0, 0});
    recorder.begin_probe(in_quarter(0));
    for (std::uint32_t path = 0; path < 100; ++path)
        record_segment(recorder, up, 2, even(path % 2 == 0 ? 0x1p-4f : 1e12f), path);
    reuse::Footprint footprint;
    recorders.store(footprint);
    const auto weight = [&](const trace::Ray& ray, std::size_t quarter) {
        const glm::ivec3 cell(
            glm::floor((ray.origin - grid.low()) / glm::vec3(grid.cell_m, grid.cell_m, grid.layer_m)));
        return reuse::weight_of_code(footprint.weight(grid.block(cell.x, cell.y, cell.z), quarter));
    };
    EXPECT_EQ(weight(up, 3), 0x1p-8f);
    EXPECT_EQ(weight(up, 1), 0x1p-12f);
    EXPECT_EQ(weight(aside, 1), 0);
    // 2^-9, and the six units that the other paths count.
    EXPECT_EQ(reuse::weight_code(weight(up, 2)), reuse::weight_code(0x1p-9f) + 1);
    EXPECT_EQ(weight(aside, 2), 0x1p-12f) << "a ray without weight is a ray";
    EXPECT_EQ(weight(up, 0), 1) << "more than can be told";
}

TEST(Footprint, QuartersAreSquaresOf32Metres) {
    const auto quarter = [](double x, double y) {
        return reuse::quarter_of({-1, 2}, placement::Position(glm::round(glm::dvec3(x, y, 0) * 1024.0)));
    };
    EXPECT_EQ(quarter(-64, 128), 0u);
    EXPECT_EQ(quarter(-64 + 31.9, 128 + 31.9), 0u);
    EXPECT_EQ(quarter(-64 + 32, 128), 1u);
    EXPECT_EQ(quarter(-64, 128 + 32), 2u);
    EXPECT_EQ(quarter(-0.1, 191.9), 3u);
    // What damaged bytes say.
    EXPECT_LT(reuse::quarter_of({INT32_MAX, INT32_MIN}, placement::Position(INT32_MIN, INT32_MAX, 0)),
              reuse::quarter_count);
}

// Every ray but the first of each path, to lamps too, is in the record for all of its way.
TEST(FootprintRecorder, AllLaterRaysOfAProbeAreNoted) {
    GltfBuilder b;
    const int leaf = b.add_material({.colour = {0.3f, 0.6f, 0.2f, 1}, .double_sided = true});
    b.add_node({.mesh = b.add_mesh(ground(90), b.add_material({.colour = {0.6f, 0.6f, 0.6f, 1}}))});
    b.place(box({8, 0, -22}, {12, 9, -8}));
    b.add_node({.mesh = b.add_mesh(quad({-20, 2, 5}, {-4, 2, 5}, {-4, 9, 9}, {-20, 9, 9}), leaf),
                .role = "vegetation"});
    for (const double x : {-12.0, 30.0})
        b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 9000}}),
                    .translation = glm::dvec3(x, 4, -14)});
    const auto world = open_world(b);
    const trace::FloatMode float_mode;
    constexpr float reach_m = 150;
    const auto scene = world->scene_for({0, 0}, 250);
    const reuse::FootprintGrid grid =
        reuse::footprint_grid({0, 0}, 250, scene->bounds().low.z, scene->bounds().high.z);
    reuse::FootprintRecorders recorders({0, 0}, grid);
    RayLog log;
    const glm::vec3 probe(3, 4, 1.5f);
    const bake::SampleTable samples(16, bake::sample_dimensions(3, true));
    for (bake::RayWatch* watch :
         {static_cast<bake::RayWatch*>(&log), static_cast<bake::RayWatch*>(&recorders.of_this_thread())}) {
        static_cast<void>(bake::integrate_probe(*scene, world->lights(), glm::ivec3(probe * 1024.0f), samples,
                                                {3, reach_m, 0}, watch));
    }
    reuse::Footprint footprint;
    recorders.store(footprint);
    const float rounding_m = 0.01f;
    int later = 0, missing = 0;
    const auto look = [&](const trace::Ray& ray, float length_m) {
        ++later;
        for (float at = 0; at <= length_m; at += 0.9f) {
            const glm::vec3 point = ray.origin + ray.direction * at;
            if (point.z < grid.low().z || point.z >= grid.high().z)
                continue;
            bool marked = false;
            for (const float dx : {-rounding_m, 0.0f, rounding_m}) {
                for (const float dy : {-rounding_m, 0.0f, rounding_m}) {
                    for (const float dz : {-0.01f, 0.0f, 0.01f}) {
                        const glm::ivec3 cell(glm::floor((point + glm::vec3(dx, dy, dz) - grid.low()) /
                                                         glm::vec3(grid.cell_m, grid.cell_m, grid.layer_m)));
                        marked |= (footprint.crossed[grid.column(cell.x, cell.y)] >> cell.z & 1u) != 0;
                    }
                }
            }
            missing += marked ? 0 : 1;
        }
    };
    for (const trace::Ray& ray : log.paths) {
        if (ray.origin == probe)
            continue;
        const auto hit = scene->closest(ray);
        look(ray, hit ? hit->distance_m : ray.far_m);
    }
    const int paths = later;
    for (const trace::Ray& ray : log.shadows)
        look(ray, ray.far_m);
    EXPECT_GE(paths, 8);
    EXPECT_GT(later - paths, 1);
    EXPECT_EQ(missing, 0);
}

reuse::Footprint baked_footprint() {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(ground(150), b.add_material({.colour = {0.4f, 0.5f, 0.3f, 1}}))});
    b.place(box({8, 0, -12}, {12, 6, -8}));
    b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 40}}),
                .translation = glm::dvec3(20, 3, -20)});
    settings::BakeSettings settings;
    settings.rays = 64;
    settings.reach_m = 60;
    return reuse::bake_and_record(*open_world(b), {0, 0}, settings).value().footprint;
}

TEST(Footprint, ComesBackAsItWasStored) {
    const reuse::Footprint footprint = baked_footprint();
    EXPECT_FALSE(footprint.probes.empty());
    EXPECT_FALSE(footprint.solid_tests.empty());
    EXPECT_GT(footprint.static_gain, 0);
    const auto back = reuse::decode_footprint(reuse::encode_footprint(footprint));
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, footprint);
}

TEST(Footprint, SmallWeightsAreRaisedWhereTheRecordWouldBeTooLarge) {
    reuse::Footprint footprint = baked_footprint();
    std::mt19937 random(11);
    footprint.grid = reuse::footprint_grid({0, 0}, 500, 0, 120);
    footprint.crossed.assign(footprint.grid.column_count(),
                             reuse::layers_between(0, footprint.grid.layers - 1));
    footprint.weights.resize(footprint.grid.block_count() * reuse::quarter_count);
    std::geometric_distribution<int> code(0.3);
    for (std::uint8_t& weight : footprint.weights)
        weight = static_cast<std::uint8_t>(std::min(code(random), 15));
    const std::vector<std::uint8_t> bytes = reuse::encode_footprint(footprint);
    EXPECT_LE(bytes.size(), reuse::max_record_bytes);
    EXPECT_GT(bytes.size(), reuse::max_record_bytes * 3 / 4);
    const auto back = reuse::decode_footprint(bytes);
    ASSERT_TRUE(back);
    // All but the smallest are as they were.
    std::uint8_t least = 15;
    for (std::size_t n = 0; n < back->weights.size(); ++n)
        least = back->weights[n] == 0 ? least : std::min(least, back->weights[n]);
    EXPECT_GT(least, 1);
    reuse::Footprint raised = footprint;
    for (std::uint8_t& weight : raised.weights)
        weight = weight == 0 ? weight : std::max(weight, least);
    EXPECT_EQ(*back, raised);
}

TEST(Footprint, WeightsStayWhereRaisingThemIsOfNoUse) {
    reuse::Footprint footprint = baked_footprint();
    std::mt19937 random(12);
    footprint.grid = reuse::footprint_grid({0, 0}, 500, 0, 120);
    footprint.crossed.resize(footprint.grid.column_count());
    for (std::uint64_t& column : footprint.crossed)
        column = random() & reuse::layers_between(0, footprint.grid.layers - 1);
    footprint.weights.assign(footprint.grid.block_count() * reuse::quarter_count, 0);
    for (placement::SolidTest test; footprint.solid_tests.size() < 3000;
         footprint.solid_tests.push_back(test))
        test.position = placement::Position(random(), random(), random());
    for (std::uint8_t& weight : footprint.weights)
        weight = static_cast<std::uint8_t>(1 + random() % 2);
    const std::vector<std::uint8_t> bytes = reuse::encode_footprint(footprint);
    EXPECT_GT(bytes.size(), reuse::max_record_bytes);
    EXPECT_GT(std::ranges::count(reuse::decode_footprint(bytes).value().weights, 1), 0);
}

TEST(Footprint, OddBytesAreNoRecord) {
    const std::vector<std::uint8_t> bytes = reuse::encode_footprint(baked_footprint());
    EXPECT_FALSE(reuse::decode_footprint({}));
    for (std::size_t size = 0; size < bytes.size(); size += 97)
        EXPECT_FALSE(reuse::decode_footprint(std::span(bytes).first(size)));
    std::mt19937 random(3);
    for (int n = 0; n < 500; ++n) {
        std::vector<std::uint8_t> broken = bytes;
        broken[random() % broken.size()] = static_cast<std::uint8_t>(random());
        static_cast<void>(reuse::decode_footprint(broken));  // anything but a crash
    }
}

}  // namespace
}  // namespace drtv::test
