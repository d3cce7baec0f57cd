// Local transfer of one sector: error of its pairs against rays and time, beside the rest of the bake:
//   local_bench MAP.glb [I J]
// Pairs that matter: of each receiver the strongest, which together make 99 % of what it gets from all.
#include "bakerd/bake/integrate.h"
#include "bakerd/bake/local_encoding.h"
#include "bakerd/bake/sector_bake.h"
#include "settings/table.h"
#include "tests/bench/bench_world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

namespace drtv::bench {
namespace {

// Of the numbers (receiver, its n-th source) those that matter.
std::vector<std::pair<std::size_t, std::size_t>> strong_pairs(const bake::LocalLight& light) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t p = 0; p < light.pairs.size(); ++p) {
        std::vector<std::pair<double, std::size_t>> row;
        double total = 0;
        for (std::size_t q = 0; q < light.pairs[p].size(); ++q) {
            row.emplace_back(static_cast<double>(light.pairs[p][q][1][0]), q);
            total += row.back().first;
        }
        std::sort(row.rbegin(), row.rend());
        double sum = 0;
        for (std::size_t n = 0; n < row.size() && sum < 0.99 * total; ++n) {
            sum += row[n].first;
            pairs.emplace_back(p, row[n].second);
        }
    }
    return pairs;
}

double difference(const bake::LocalCoefficients& a, const bake::LocalCoefficients& b) {
    double square = 0, size = 0;
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t i = 0; i < sh_count; ++i) {
            square += std::pow(static_cast<double>(a[c][i] - b[c][i]), 2);
            size += std::pow(static_cast<double>(b[c][i]), 2);
        }
    }
    return std::sqrt(square / size);
}

int run(const std::string& path, std::optional<map::SectorCoordinate> chosen) {
    const trace::FloatMode float_mode;
    const auto world = open_world(path);
    if (!world)
        return 1;
    const map::SectorCoordinate at = chosen.value_or(middle_sector(*world));
    settings::BakeSettings settings = settings::preset("pc")->bake;
    const auto scene = world->scene_for(at, bake::scene_distance_m(world->placement_tags(), settings));
    std::vector<std::shared_ptr<const bake::Placed>> around;
    std::vector<const bake::PlacedSector*> neighbours;
    for (int k = 0; k < 9; ++k) {
        const map::SectorCoordinate coordinate{at.i + k % 3 - 1, at.j + k / 3 - 1};
        if (k == 4 || !world->has_sector(coordinate))
            continue;
        around.push_back(world->placed(coordinate, settings, *scene));
        neighbours.push_back(&**around.back());
    }
    const auto own = world->placed(at, settings, *scene);
    const bake::PlacedSector& placed = **own;
    const bake::LocalSources sources = bake::local_sources(placed, neighbours, settings.reach_m);
    const std::size_t receivers = placed.positions.size();

    settings::BakeSettings rest = settings;
    rest.local_transfer = false;
    static_cast<void>(bake::bake_sector(*world, at, rest).value());
    std::vector<double> rest_seconds;
    for (int n = 0; n < 3; ++n) {
        const double start = seconds();
        static_cast<void>(bake::bake_sector(*world, at, rest).value());
        rest_seconds.push_back(seconds() - start);
    }
    std::sort(rest_seconds.begin(), rest_seconds.end());
    std::printf("sector (%d, %d): %zu probes, %zu sources; the rest of the bake: %.0f ms\n", at.i, at.j,
                receivers, sources.positions.size(), rest_seconds[1] * 1e3);

    const auto local_with = [&](std::uint32_t rays) {
        return bake::integrate_local(
            *scene, sources.positions, sources.of_receivers,
            *world->samples(rays, bake::local_sample_dimensions(settings.local_bounces)),
            {settings.local_bounces, settings.reach_m});
    };
    const bake::LocalLight truth = local_with(8192);
    const auto pairs = strong_pairs(truth);
    for (const std::uint32_t rays : {16u, 32u, 64u, 128u, 256u, 512u, 1024u}) {
        double best = 1e30;
        bake::LocalLight light;
        for (int n = 0; n < 3; ++n) {
            const double start = seconds();
            light = local_with(rays);
            best = std::min(best, seconds() - start);
        }
        std::vector<double> errors;
        for (const auto& [p, q] : pairs)
            errors.push_back(difference(light.pairs[p][q], truth.pairs[p][q]));
        std::sort(errors.begin(), errors.end());
        std::printf(
            "rays %4u: %6.0f ms (%.2f of the rest), %7.0f k rays, error of %zu pairs: median %.2f %%, p95 "
            "%.2f %%\n",
            rays, best * 1e3, best / rest_seconds[1], static_cast<double>(light.rays) / 1e3, errors.size(),
            100 * errors[errors.size() / 2], 100 * errors[errors.size() * 95 / 100]);
        if (rays == settings.local_rays) {
            const LocalTransfer stored = bake::encode_local(sources, light);
            std::vector<double> rounding;
            for (std::size_t p = 0; p < receivers; ++p) {
                std::uint32_t n = stored.receivers[p].first_pair;
                for (std::size_t k = 0; k < sources.of_receivers[p].size(); ++k) {
                    const std::size_t q = sources.of_receivers[p][k];
                    if (!has_pair(stored.receivers[p], q))
                        continue;
                    const float scale =
                        scale_of_exponent(stored.receivers[p].exponent + stored.sources[q].exponent);
                    bake::LocalCoefficients decoded{};
                    for (std::size_t c = 0; c < channel_count; ++c) {
                        for (std::size_t i = 0; i < sh_count; ++i)
                            decoded[c][i] = decode_fixed(stored.pairs[n][c][i], scale);
                    }
                    ++n;
                    if (light.pairs[p][k][1][0] > 0)
                        rounding.push_back(difference(decoded, light.pairs[p][k]));
                }
            }
            std::sort(rounding.begin(), rounding.end());
            std::printf("  stored: %zu of %zu pairs; rounding of those stored: median %.3f %%, p95 %.3f %%\n",
                        stored.pairs.size(), receivers * sources.positions.size(),
                        100 * rounding[rounding.size() / 2], 100 * rounding[rounding.size() * 95 / 100]);
        }
    }
    return 0;
}

}  // namespace
}  // namespace drtv::bench

int main(int argc, char** argv) {
    if (argc != 2 && argc != 4) {
        std::fprintf(stderr, "usage: local_bench MAP.glb [I J]\n");
        return 1;
    }
    std::optional<drtv::map::SectorCoordinate> sector;
    if (argc == 4)
        sector = {std::atoi(argv[2]), std::atoi(argv[3])};
    return drtv::bench::run(argv[1], sector);
}
