// Speed of the runtime on one core: 51 sectors of 70 probes as the talk has them, each figure beside a memcpy
// of the bytes that it writes, in turns within one run. runtime_bench [ROUNDS]
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/ambient.h>
#include <drtv/volume.h>
#include <drtv/write.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace drtv::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t sector_count = 51;
constexpr std::size_t probes_per_sector = 70;
constexpr SectorSetLimits limits{.sectors = 64, .probes = 64 * 80, .interiors = 64, .tiles = 256};

double microseconds(const std::function<void()>& work) {
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

double at_share(std::vector<double> times, double share) {
    std::sort(times.begin(), times.end());
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
}

// Median time of some work, beside that of a memcpy of so many bytes, in turns.
void report(const char* name, std::size_t bytes, int rounds, const std::function<void(int)>& work) {
    std::vector<char> from(bytes + 1, 1), to(bytes + 1);
    std::vector<double> times, copies;
    for (int n = 0; n < rounds; ++n) {
        times.push_back(microseconds([&] { work(n); }));
        copies.push_back(microseconds([&] { std::memcpy(to.data(), from.data(), bytes); }));
    }
    const double median = at_share(times, 0.5), copy = at_share(copies, 0.5);
    std::printf("%-52s %9.1f us  p99 %9.1f  memcpy of %8zu B %8.1f us  ratio %6.2f\n", name, median,
                at_share(times, 0.99), bytes, copy, median / copy);
}

SceneLight light_at(int n, RelightMode mode) {
    SceneLight light;
    light.mode = mode;
    const float turn = 0.01f * static_cast<float>(n);
    light.sun = {{100, 90, 80}, {1, turn, 0.5f}};
    light.sky = gradient_sky({{2, 4, 8}, {6, 8, 10}, {1, 1, 1}}, light.sun.direction);
    return light;
}

// A sector of 70 probes with static light and local transfer: each receives from its nearest 128 of nine
// sectors, by index. The numbers mean nothing.
Sector town_sector(SectorId id) {
    Sector sector =
        test::random_sector_1_1(static_cast<std::uint32_t>(id.i * 31 + id.j + 900), probes_per_sector);
    sector.i = id.i;
    sector.j = id.j;
    sector.grid.z_origin_units = 0;
    sector.grid.cell_height_units = position_units_per_m;
    // Each cell names another probe than those beside it, so that a lamp has eight shares.
    for (std::size_t n = 0; n < grid_cell_count; ++n)
        sector.grid.cells[n] =
            static_cast<std::uint8_t>((n % 16 + 17 * (n / 16 % 16) + 31 * (n / 256)) % probes_per_sector);
    LocalTransfer local;
    for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
            for (std::size_t p = 0; p < probes_per_sector; ++p)
                local.sources.push_back({static_cast<std::int8_t>(di), static_cast<std::int8_t>(dj),
                                         static_cast<std::uint8_t>(p), 0});
        }
    }
    local.receivers.resize(probes_per_sector);
    const LightCodes codes = {{{9000, 100, 2000, 300}, {8000, 100, 2000, 300}, {7000, 100, 2000, 300}}};
    for (std::size_t p = 0; p < probes_per_sector; ++p) {
        std::vector<std::size_t> pairs;
        for (std::size_t n = 0; n < max_local_sources; ++n)
            pairs.push_back((p + n * 5) % local.sources.size());
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        test::add_pairs(local, p, pairs, codes);
    }
    sector.local_transfer = local;
    return sector;
}

int run(int rounds) {
    test::OwnedSet set(limits);
    std::array<SectorId, sector_count> wanted;
    const std::size_t count = wanted_sectors({32, 32, 0}, 1000, wanted);
    std::vector<const LoadedSector*> sectors;
    for (std::size_t n = 0; n < count; ++n)
        sectors.push_back(&set.add(town_sector(wanted[n])));

    std::vector<std::byte> relit_memory(RelitProbes::memory_bytes(limits, false));
    RelitProbes relit(relit_memory, limits, false);
    const auto relight_all = [&](int n, RelightMode mode) {
        const SceneLight light = light_at(n, mode);
        relit.set_light(Shown::now, light);
        for (const LoadedSector* sector : sectors)
            relit.relight(Shown::now, *sector, light, {});
    };
    constexpr std::size_t output = sector_count * probes_per_sector * sizeof(PackedColours);
    std::printf("%zu sectors, %zu probes each\n", count, probes_per_sector);
    report("relight, sun, sky and static, accurate", output, rounds,
           [&](int n) { relight_all(n, RelightMode::accurate); });
    report("relight, sun, sky and static, literal", output, rounds,
           [&](int n) { relight_all(n, RelightMode::literal); });

    std::vector<LightShare> shares;
    for (int lamp = 0; lamp < 8; ++lamp) {
        std::array<LightShare, max_shares_per_light> split;
        const PointLight light{{13.0 + 9 * lamp, 21.0 - 3 * lamp, 5.2}, {10, 10, 10}};
        const std::size_t found = split_light(*set, light, split);
        shares.insert(shares.end(), split.begin(), split.begin() + static_cast<std::ptrdiff_t>(found));
    }
    std::vector<BasisColours> lit(limits.probes);
    const std::string lamps = "8 lamps of " + std::to_string(shares.size()) + " shares into all probes";
    report(lamps.c_str(), output, rounds, [&](int) {
        for (const LoadedSector* sector : sectors) {
            const LocalRelighter local(*sector, shares);
            if (local.empty())
                continue;
            for (std::size_t p = 0; p < sector->view.probe_count; ++p)
                local.add_to(lit[sector->first_probe + p], p);
        }
    });

    for (const TexelEncoding encoding :
         {TexelEncoding::rgba8, TexelEncoding::rgba8_sqrt, TexelEncoding::rgba16f}) {
        VolumeSettings settings;
        settings.encoding = encoding;
        std::vector<std::byte> memory(Volume::memory_bytes(settings, limits));
        Volume volume(memory, settings, limits);
        volume.set_scale(64);
        const char* names[] = {"rgba8", "rgba8-sqrt", "rgba16f"};
        const std::string name = names[static_cast<std::size_t>(encoding)];
        const std::size_t bytes = 3 * volume.texels(0).size();
        volume.update(*set, relit, {32, 32, 8});
        report((name + ", full update").c_str(), bytes, rounds, [&](int) {
            volume.update_all(*set, relit, {32, 32, 8});
        });
        const std::size_t plane = bytes / 98;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::string move = name + ", a move by one texel along " + "xyz"[axis];
            report(move.c_str(), plane, rounds, [&](int n) {
                Double3 camera = {32, 32, 8};
                camera[axis] += 4 * (n % 2);
                volume.update(*set, relit, camera);
            });
        }
        report((name + ", encoding all probes and a full update").c_str(), bytes, rounds, [&](int n) {
            relit.set_fade(0);
            relight_all(n, RelightMode::accurate);
            volume.update_all(*set, relit, {32, 32, 8});
        });
    }
    VolumeSettings blurred;
    blurred.blur = true;
    std::vector<std::byte> memory(Volume::memory_bytes(blurred, limits));
    Volume volume(memory, blurred, limits);
    report("rgba8, blurred, full update", 3 * volume.texels(0).size(), std::min(rounds, 50), [&](int) {
        volume.update_all(*set, relit, {32, 32, 8});
    });

    // A sector arrives: open, relight, tile, texels. As a game does, another leaves.
    std::vector<std::byte> plain_memory(Volume::memory_bytes({}, limits));
    Volume plain(plain_memory, {}, limits);
    plain.update(*set, relit, {32, 32, 8});
    std::vector<std::vector<std::uint8_t>> files;
    for (const LoadedSector* sector : sectors) {
        Sector bare = town_sector({sector->view.i, sector->view.j});
        bare.local_transfer.reset();
        files.push_back(write_sector(bare));
    }
    const SceneLight light = light_at(0, RelightMode::accurate);
    std::vector<double> arrivals, opens;
    for (int n = 0; n < 1000; ++n) {
        const std::size_t s = static_cast<std::size_t>(n) % 9;
        set->drop(wanted[s]);
        set->retire();
        plain.update(*set, relit, {32, 32, 8});
        arrivals.push_back(microseconds([&] {
            const LoadedSector* loaded = nullptr;
            set->load(files[s], &loaded);
            relit.relight(Shown::now, *loaded, light, {});
            plain.update(*set, relit, {32, 32, 8});
        }));
        opens.push_back(microseconds([&] {
            SectorView view;
            (void)open_sector(files[s], view);
        }));
    }
    std::printf("a sector of %zu B arrives: median %.1f us, p99 %.1f us, of which open_sector %.1f us\n",
                files[0].size(), at_share(arrivals, 0.5), at_share(arrivals, 0.99), at_share(opens, 0.5));
    std::vector<double> places;
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> side(-150, 150);
    Float3 sum{};
    for (int n = 0; n < 2000; ++n) {
        const Double3 at = {side(engine), side(engine), 3};
        places.push_back(microseconds([&] {
            const Ambient ambient = ambient_at(*set, light, {}, {.at = at});
            sum[0] += ambient.colour[0];
        }));
    }
    std::printf("ambient_at, trilinear: median %.2f us (%g)\n", at_share(places, 0.5),
                static_cast<double>(sum[0]));
    return 0;
}

}  // namespace
}  // namespace drtv::bench

int main(int argc, char** argv) {
    return drtv::bench::run(argc > 1 ? std::max(std::atoi(argv[1]), 10) : 400);
}
