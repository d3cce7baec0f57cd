// Error against time of the samplers that were tried, on the probes of one sector:
//   sampler_bench MAP.glb
// The error is that of E/pi relit by a sky of radiance 1, and of all coefficients of the transfer: root mean
// square over probes, over their mean, against 65,536 joint paths. `time` is that which the sampler needs for
// the error of 2,048 joint paths.
#include "bakerd/bake/integrate.h"
#include "tests/bench/bench_world.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace drtv::bench {
namespace {

constexpr std::uint32_t bounces = 3, dimensions = 2 + 2 * bounces;

bake::SampleTable plain(std::uint32_t count) {
    std::mt19937 random(1);
    std::vector<std::uint32_t> words(std::size_t{count} * dimensions);
    for (std::uint32_t& word : words)
        word = static_cast<std::uint32_t>(random());
    return {std::move(words), dimensions};
}

bake::SampleTable joint(std::uint32_t count) {
    return {count, dimensions};
}

// Each bounce has a Sobol pattern of two dimensions of its own, shuffled against the others.
bake::SampleTable padded(std::uint32_t count) {
    const bake::SampleTable pattern(count, 2);
    std::vector<std::uint32_t> words(std::size_t{count} * dimensions), order(count);
    std::mt19937 random(2);
    for (std::uint32_t pair = 0; pair < dimensions / 2; ++pair) {
        for (std::uint32_t n = 0; n < count; ++n)
            order[n] = n;
        if (pair > 0)
            std::shuffle(order.begin(), order.end(), random);
        const auto x = static_cast<std::uint32_t>(random()), y = static_cast<std::uint32_t>(random());
        for (std::uint32_t n = 0; n < count; ++n) {
            words[std::size_t{n} * dimensions + 2 * pair] = pattern.point(order[n])[0] ^ x;
            words[std::size_t{n} * dimensions + 2 * pair + 1] = pattern.point(order[n])[1] ^ y;
        }
    }
    return {std::move(words), dimensions};
}

struct Errors {
    double relit = 0, all = 0, seconds = 0;
};

std::vector<bake::ProbeLight> baked(const bake::World& world, const trace::Scene& scene,
                                    const std::vector<placement::Position>& probes,
                                    const bake::SampleTable& samples) {
    std::vector<bake::ProbeLight> lights;
    for (const auto& probe : probes)
        lights.push_back(bake::integrate_probe(scene, world.lights(), probe, samples, {bounces, 512, 0}));
    return lights;
}

Errors errors_of(const std::vector<bake::ProbeLight>& lights, const std::vector<bake::ProbeLight>& truth) {
    constexpr std::array<double, 4> open = {0.788675, 0.788675, 0.788675, 0};
    double relit_square = 0, relit_mean = 0, all_square = 0, all_mean = 0;
    std::size_t relit_count = 0, all_count = 0;
    for (std::size_t p = 0; p < lights.size(); ++p) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                const auto relit = [&](const bake::ProbeLight& l) {
                    return static_cast<double>(l.transfer[c][b][0]) / static_cast<double>(sh_y0) +
                           static_cast<double>(l.sky_visibility[b]) * open[b];
                };
                relit_square += std::pow(relit(lights[p]) - relit(truth[p]), 2);
                relit_mean += relit(truth[p]);
                ++relit_count;
                for (std::size_t i = 0; i < sh_count; ++i) {
                    all_square += std::pow(
                        static_cast<double>(lights[p].transfer[c][b][i] - truth[p].transfer[c][b][i]), 2);
                    all_mean += std::abs(static_cast<double>(truth[p].transfer[c][b][i]));
                    ++all_count;
                }
            }
        }
    }
    const auto relative = [](double square, double mean, std::size_t count) {
        return std::sqrt(square / static_cast<double>(count)) / (mean / static_cast<double>(count));
    };
    return {relative(relit_square, relit_mean, relit_count), relative(all_square, all_mean, all_count), 0};
}

int run(const std::string& path) {
    const trace::FloatMode float_mode;
    const auto world = open_world(path);
    if (!world)
        return 1;
    const map::SectorCoordinate at = middle_sector(*world);
    const settings::BakeSettings settings;
    const auto scene = world->scene_for(at, bake::scene_distance_m(world->placement_tags(), settings));
    const auto placed = world->placed(at, settings, *scene);
    const std::vector<placement::Position>& probes = (*placed)->positions;
    const auto truth = baked(*world, *scene, probes, joint(65536));
    std::printf("sector (%d, %d), %zu probes\n", at.i, at.j, probes.size());

    struct Sampler {
        const char* name;
        std::function<bake::SampleTable(std::uint32_t)> make;
        std::vector<Errors> by_count;
    };
    std::vector<Sampler> samplers = {
        {"plain Monte Carlo", plain, {}}, {"padded Owen-Sobol", padded, {}}, {"joint Owen-Sobol", joint, {}}};
    const std::vector<std::uint32_t> counts = {256, 512, 1024, 2048, 4096, 8192};
    for (const std::uint32_t count : counts) {
        for (Sampler& sampler : samplers) {
            const bake::SampleTable samples = sampler.make(count);
            const double start = seconds();
            const auto lights = baked(*world, *scene, probes, samples);
            const double took = seconds() - start;
            sampler.by_count.push_back(errors_of(lights, truth));
            sampler.by_count.back().seconds = took;
            std::printf("%5u paths, %-18s %6.2f ms a probe, relit %.2f %%, all %.2f %%\n", count,
                        sampler.name, took * 1e3 / static_cast<double>(probes.size()),
                        100 * sampler.by_count.back().relit, 100 * sampler.by_count.back().all);
        }
    }
    // Straight lines in the logarithms of error and time, by least squares.
    for (const auto& [what, member] : {std::pair("relit", &Errors::relit), std::pair("all", &Errors::all)}) {
        const auto seconds_for = [&](const Sampler& sampler, double error) {
            double n = 0, x = 0, y = 0, xx = 0, xy = 0;
            for (const Errors& e : sampler.by_count) {
                const double lx = std::log(e.*member), ly = std::log(e.seconds);
                n += 1, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
            }
            const double slope = (n * xy - x * y) / (n * xx - x * x);
            return std::exp((y - slope * x) / n + slope * std::log(error));
        };
        const double error = samplers[2].by_count[3].*member, joint_seconds = seconds_for(samplers[2], error);
        for (const Sampler& sampler : samplers)
            std::printf("%-5s %.2f %%: %-18s %.1f times the time of joint\n", what, 100 * error, sampler.name,
                        seconds_for(sampler, error) / joint_seconds);
    }
    return 0;
}

}  // namespace
}  // namespace drtv::bench

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: sampler_bench MAP.glb\n");
        return 1;
    }
    return drtv::bench::run(argv[1]);
}
