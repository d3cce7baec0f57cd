#include "tests/format/sectors.h"

#include <algorithm>
#include <random>
#include <utility>

namespace drtv::test {
namespace {

using Row = Float4;

std::array<std::int16_t, sh_count> codes(const Row& row, float factor) {
    std::array<std::int16_t, sh_count> q{};
    for (std::size_t i = 0; i < sh_count; ++i)
        q[i] = encode_fixed(row[i] * factor, transfer_scale);
    return q;
}

// Over an endless plane of albedo 1 (SPEC.md, section 8): the share of each lobe that meets it, times (Y0, 0,
// 2/3 Y1, 0).
constexpr Row plane_up = {0.0596112f, 0, 0.0688331f, 0}, plane_down = {0.282095f, 0, 0.325735f, 0};
// Beside a wall to the east: made up, with every coefficient another.
constexpr std::array<Row, basis_count> wall = {{{0.08f, -0.02f, 0.07f, -0.03f},
                                                {0.08f, 0.02f, 0.07f, -0.03f},
                                                {0.12f, 0.005f, 0.06f, -0.1f},
                                                {0.2f, -0.01f, 0.22f, -0.04f}}};

class Random {
  public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    // The standard's distributions differ from library to library; the engine does not.
    std::int64_t between(std::int64_t least, std::int64_t most) {
        return least + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(most - least + 1));
    }
    template <class Integer>
    Integer any() {
        return static_cast<Integer>(engine_());
    }

  private:
    std::mt19937_64 engine_;
};

// With so many receivers, and pairs of most of them and most sources.
LocalTransfer random_local_transfer(Random& random, std::size_t probe_count,
                                    std::vector<LocalSource> sources) {
    LocalTransfer local;
    local.sources = std::move(sources);
    local.receivers.resize(probe_count);
    for (LocalSource& source : local.sources)
        source.exponent = static_cast<std::int8_t>(random.between(-30, 31));
    for (std::size_t p = 0; p < probe_count; ++p) {
        local.receivers[p].exponent = static_cast<std::int8_t>(random.between(-96, 32));
        add_pairs(local, p, {}, {});
        std::size_t left = max_local_sources;
        for (std::size_t s = 0; s < local.sources.size() && left > 0; ++s) {
            if (random.between(0, 2) == 0)
                continue;
            LightCodes codes;
            for (auto& channel : codes) {
                channel[0] = static_cast<std::int16_t>(random.between(0, 28000));
                for (std::size_t i = 1; i < sh_count; ++i)
                    channel[i] = static_cast<std::int16_t>(random.between(-channel[0], channel[0]));
            }
            add_pairs(local, p, {s}, codes);
            --left;
        }
    }
    return local;
}

StaticIrradiance random_irradiance(Random& random) {
    StaticIrradiance light;
    for (auto& channel : light.codes) {
        for (std::int16_t& q : channel)
            q = static_cast<std::int16_t>(random.between(0, 32767));
    }
    light.exponent = static_cast<std::int8_t>(random.between(-64, 64));
    return light;
}

}  // namespace

void fill_grid(Sector& sector, const std::function<std::size_t(std::size_t)>& choose) {
    constexpr std::size_t considered = 4;
    sector.grid.cells.fill(no_probe);
    for (std::size_t cell = 0; cell < grid_cell_count && !sector.probes.empty(); ++cell) {
        const std::array<std::int64_t, 3> index = {static_cast<std::int64_t>(cell % 16),
                                                   static_cast<std::int64_t>(cell / 16 % 16),
                                                   static_cast<std::int64_t>(cell / 256)};
        const std::int64_t height = sector.grid.cell_height_units;
        std::vector<std::pair<double, std::size_t>> nearest;
        for (std::size_t p = 0; p < sector.probes.size(); ++p) {
            const auto& position = sector.probes[p].position;
            const std::int64_t z = std::int64_t{sector.z_origin_units} +
                                   (std::int64_t{position[2]} << sector.z_shift) - sector.grid.z_origin_units;
            const auto dx = static_cast<double>(position[0] - (4096 * index[0] + 2048)),
                       dy = static_cast<double>(position[1] - (4096 * index[1] + 2048));
            const auto dz = static_cast<double>(z - (height * index[2] + height / 2));
            nearest.emplace_back(dx * dx + dy * dy + dz * dz, p);
        }
        std::ranges::sort(nearest);
        sector.grid.cells[cell] =
            static_cast<std::uint8_t>(nearest[choose(std::min(considered, nearest.size()))].second);
    }
}

Sector golden_sector() {
    Sector sector;
    sector.i = -1;
    sector.j = 2;
    sector.z_origin_units = 10240;
    sector.z_shift = 1;
    sector.probes.resize(2);
    Probe& open = sector.probes[0];
    open.position = {16384, 32768, 1024};
    open.kind = ProbeKind::ground;
    open.sky_visibility = {32767, 32767, 32767, 0};
    Probe& beside_wall = sector.probes[1];
    beside_wall.position = {49152, 32768, 0};
    beside_wall.kind = ProbeKind::manual;
    beside_wall.sky_visibility = {29490, 29490, 16384, 0};
    constexpr Float3 albedo = {0.5f, 0.25f, 0.125f};
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            open.transfer[c][b] = codes(b == basis_count - 1 ? plane_down : plane_up, albedo[c]);
            beside_wall.transfer[c][b] = codes(wall[b], albedo[c]);
        }
    }
    sector.grid.z_origin_units = 8192;
    sector.grid.cell_height_units = 1024;
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell)
        sector.grid.cells[cell] = cell % grid_size < 8 ? 0 : 1;
    sector.bake.rays = 2048;
    sector.bake.bounces = 3;
    sector.bake.reach_m = 512;
    sector.bake.min_distance_m = 6;
    for (std::size_t n = 0; n < 32; ++n)
        sector.bake.settings_key[n] = static_cast<std::uint8_t>(n);
    sector.statistics = {9, 1, 2, 3, 4, 7.5f, 12288, 5};
    return sector;
}

Sector golden_sector_1_1() {
    Sector sector = golden_sector();
    Probe& leaves = sector.probes.emplace_back(sector.probes[1]);
    leaves.position = {49152, 49152, 512};
    leaves.kind = ProbeKind::vegetation;
    sector.static_irradiance = {
        {{{{16384, 8192, 4096, 32767}, {1, 2, 3, 4}, {0, 0, 0, 1}}}, 0},
        {{{{100, 200, 300, 400}, {500, 600, 700, 800}, {900, 1000, 1100, 1200}}}, -64},
        {{{{32767, 0, 0, 0}, {0, 32767, 0, 0}, {0, 0, 32767, 0}}}, 5}};
    LocalTransfer& local = sector.local_transfer.emplace();
    local.sources = {{0, 0, 0, 2}, {0, 0, 1, 0}, {1, -1, 254, -3}};
    local.receivers.resize(sector.probes.size());
    constexpr LightCodes up = {{{16000, 0, 12000, 0}, {8000, 0, 6000, 0}, {4000, 0, 3000, 0}}};
    // The greatest that band 1 may be: 1.1548 * 10000 + 1.
    constexpr LightCodes at_bound = {{{10000, 11549, 0, 0}, {10000, 0, -11549, 0}, {10000, 0, 0, 11549}}};
    add_pairs(local, 0, {1}, up);
    add_pairs(local, 1, {0, 1, 2}, at_bound);
    add_pairs(local, 2, {2}, {{{32767, -1, -2, -3}, {0, 0, 0, 0}, {1, 2, 2, -2}}});
    local.pairs[2] = up;
    local.receivers[0].exponent = -4;
    local.receivers[1].exponent = -2;
    local.receivers[2].exponent = -123;
    sector.convergence = {0.02f, 0.0125f, 0.01875f, 0.03125f, 256, 4096, 3, 65536, 1'234'567, 7'654'321'000};
    return sector;
}

Sector golden_sector_1_2() {
    Sector sector = golden_sector_1_1();
    // Around probe 1 at (-16, 160, 10) m and probe 2 at (-16, 176, 11) m.
    sector.interiors = {box_interior({-20480, 159744, 9216}, {0, 0, 0}, {8192, 8192, 4096}),
                        box_interior({-24576, 172032, 8192}, {0, 64, 128}, {1024, 1088, 640})};
    sector.interiors[0].probe = 1;
    sector.interiors[1].probe = 2;
    sector.interiors[1].shift = 4;
    // A roof: one more vertex over the middle, so that parts do not end at multiples of 16.
    Interior& roofed = sector.interiors[1];
    roofed.vertices.push_back({512, 576, 700});
    std::erase(roofed.triangles, std::array<std::uint16_t, 3>{4, 5, 7});
    std::erase(roofed.triangles, std::array<std::uint16_t, 3>{4, 7, 6});
    for (const auto& triangle : {std::array<std::uint16_t, 3>{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}})
        roofed.triangles.push_back(triangle);
    return sector;
}

Sector golden_sector_1_3() {
    Sector sector = golden_sector_1_2();
    constexpr LightCodes lamp = {{{32767, 8192, 4096, 2048}, {1024, 512, 256, 128}, {64, 32, 16, 8}}};
    constexpr LightCodes window = {{{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}}};
    sector.light_groups = {{"lanterns", {{lamp, -3}, {{}, -64}, {window, 64}}},
                           {"n\u00e4chtliche Fenster", {{window, 0}, {lamp, 1}, {{}, -64}}}};
    Quality& quality = sector.quality.emplace();
    quality.buried_cells = 100;
    quality.blind_cells = 7;
    quality.probes = {{0.0078125f, 0.00390625f, 0.125f, 2048, 5, false, false, false},
                      {0.5f, 0, 0, 4096, 0, true, false, true},
                      {0, 0, 0, 256, 256, false, true, false}};
    quality.group_errors = {{0.25f, 0, 1.5f}, {0.0625f, 0.03125f, 0}};
    // The last of them alone are used.
    LocalTransfer& local = *sector.local_transfer;
    std::vector<LocalSource> sources = neighbouring_sources(257);
    sources.insert(sources.end(), local.sources.begin(), local.sources.end() - 1);
    local.sources = std::move(sources);
    const std::vector<LocalReceiver> receivers = std::exchange(local.receivers, {});
    const std::vector<LightCodes> pairs = std::exchange(local.pairs, {});
    local.receivers.resize(receivers.size());
    add_pairs(local, 0, {0, 254}, pairs[0]);
    add_pairs(local, 1, {255, 256, 257, 258}, pairs[1]);
    add_pairs(local, 2, {258}, pairs[4]);
    for (std::size_t p = 0; p < receivers.size(); ++p)
        local.receivers[p].exponent = receivers[p].exponent;
    return sector;
}

Interior box_interior(const std::array<std::int32_t, 3>& origin_units,
                      const std::array<std::uint16_t, 3>& low, const std::array<std::uint16_t, 3>& high) {
    Interior interior;
    interior.origin_units = origin_units;
    // Corner k: bit 0 for x, 1 for y, 2 for z.
    for (std::size_t k = 0; k < 8; ++k)
        interior.vertices.push_back({(k & 1) != 0 ? high[0] : low[0], (k & 2) != 0 ? high[1] : low[1],
                                     (k & 4) != 0 ? high[2] : low[2]});
    interior.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                          {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return interior;
}

std::vector<LocalSource> neighbouring_sources(std::size_t probes) {
    std::vector<LocalSource> sources;
    constexpr std::array<std::array<std::int8_t, 2>, 8> around = {
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
    for (std::size_t n = 0; n < probes; ++n) {
        const auto [di, dj] = around[n / max_probes];
        sources.push_back({di, dj, static_cast<std::uint8_t>(n % max_probes), 0});
    }
    return sources;
}

void add_pairs(LocalTransfer& local, std::size_t p, const std::vector<std::size_t>& sources,
               const LightCodes& codes) {
    // All receivers have masks of one size.
    for (LocalReceiver& receiver : local.receivers)
        receiver.sources.resize(local_mask_bytes(local.sources.size()));
    for (std::size_t s : sources) {
        local.receivers[p].sources[s >> 3] |= static_cast<std::uint8_t>(1u << (s & 7));
        local.pairs.push_back(codes);
    }
    for (std::size_t later = p + 1; later < local.receivers.size(); ++later) {
        local.receivers[later].first_pair = static_cast<std::uint32_t>(local.pairs.size());
    }
}

Sector random_sector(std::uint32_t seed, std::size_t probe_count) {
    Random random(seed);
    Sector sector;
    sector.i = static_cast<std::int32_t>(random.between(-max_sector_coordinate, max_sector_coordinate));
    sector.j = static_cast<std::int32_t>(random.between(-max_sector_coordinate, max_sector_coordinate));
    sector.z_origin_units =
        static_cast<std::int32_t>(random.between(-max_z_origin_units, max_z_origin_units));
    sector.z_shift = static_cast<std::uint8_t>(random.between(0, max_z_shift));
    for (std::size_t p = 0; p < probe_count; ++p) {
        Probe probe;
        // Distinct in x: no two probes stand at one place.
        probe.position = {static_cast<std::uint16_t>(256 * p + random.any<std::uint8_t>()),
                          random.any<std::uint16_t>(), random.any<std::uint16_t>()};
        probe.kind = static_cast<ProbeKind>(random.between(0, 2));
        for (std::size_t b = 0; b < 3; ++b)
            probe.sky_visibility[b] = static_cast<std::int16_t>(random.between(0, 32767));
        for (auto& channel : probe.transfer) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                // What the sky leaves of 1: 18487 codes are 1 / 3.5449. Band 1 within sqrt(3) of band 0, and
                // Y2 not below 0.
                const std::int64_t most =
                    18487 - (probe.sky_visibility[b] * std::int64_t{18487} * 789 / 32767 + 999) / 1000;
                const std::int64_t y0 = random.between(0, most),
                                   y1 = std::min<std::int64_t>(y0 * 1732 / 1000, 32026);
                channel[b] = {static_cast<std::int16_t>(y0),
                              static_cast<std::int16_t>(random.between(-y1, y1)),
                              static_cast<std::int16_t>(random.between(0, y1)),
                              static_cast<std::int16_t>(random.between(-y1, y1))};
            }
        }
        sector.probes.push_back(probe);
    }
    sector.grid.z_origin_units =
        static_cast<std::int32_t>(random.between(-max_z_origin_units, max_z_origin_units));
    sector.grid.cell_height_units = static_cast<std::uint32_t>(random.between(1, max_cell_height_units));
    fill_grid(sector, [&](std::size_t nearest) {
        return static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(nearest) - 1));
    });
    sector.bake.rays = static_cast<std::uint32_t>(random.between(1, UINT32_MAX));
    sector.bake.bounces = random.any<std::uint32_t>();
    sector.bake.reach_m = static_cast<float>(random.between(1, 1 << 20)) / 64;
    sector.bake.min_distance_m = static_cast<float>(random.between(1, 1 << 20)) / 64;
    for (std::uint8_t& byte : sector.bake.settings_key)
        byte = random.any<std::uint8_t>();
    sector.statistics.candidates = random.any<std::uint32_t>();
    sector.statistics.moved_out = random.any<std::uint32_t>();
    sector.statistics.dropped_in_solid = random.any<std::uint32_t>();
    sector.statistics.removed_by_volume = random.any<std::uint32_t>();
    sector.statistics.thinned = random.any<std::uint32_t>();
    sector.statistics.used_distance_m = static_cast<float>(random.between(0, 1 << 20)) / 64;
    sector.statistics.rays = random.any<std::uint64_t>();
    sector.statistics.back_hits = random.any<std::uint64_t>();
    return sector;
}

Sector random_sector_1_1(std::uint32_t seed, std::size_t probe_count) {
    Sector sector = random_sector(seed, probe_count);
    Random random(seed + 1000);
    for (std::size_t p = 0; p < probe_count; ++p)
        sector.static_irradiance.push_back(random_irradiance(random));
    // Both widths of the masks, and the ends of both.
    constexpr std::array<std::int64_t, 6> source_counts = {0, 1, 127, 128, 129, 255};
    std::vector<LocalSource> sources =
        neighbouring_sources(static_cast<std::size_t>(source_counts[seed % source_counts.size()]));
    for (LocalSource& source : sources)
        source.dj = static_cast<std::int8_t>(random.between(-1, 1));
    sector.local_transfer = random_local_transfer(random, probe_count, std::move(sources));
    const auto error = [&](float least) {
        return least + static_cast<float>(random.between(0, 1 << 20)) / (1 << 20);
    };
    Convergence& c = sector.convergence.emplace();
    c.error_asked = error(0);
    c.error_median = error(0);
    c.error_p95 = error(c.error_median);
    c.error_max = error(c.error_p95);
    c.paths_least = static_cast<std::uint32_t>(random.between(0, 1 << 20));
    c.paths_most = c.paths_least + static_cast<std::uint32_t>(random.between(0, 1 << 20));
    c.local_bounces = random.any<std::uint32_t>();
    c.local_rays = random.any<std::uint32_t>();
    c.static_rays = random.any<std::uint64_t>();
    c.local_transfer_rays = random.any<std::uint64_t>();
    return sector;
}

Sector random_sector_1_2(std::uint32_t seed, std::size_t probe_count) {
    Sector sector = random_sector_1_1(seed, probe_count);
    Random random(seed + 2000);
    for (std::int64_t n = probe_count == 0 ? 0 : random.between(1, 3); n > 0; --n) {
        const auto p =
            static_cast<std::uint8_t>(random.between(0, static_cast<std::int64_t>(probe_count) - 1));
        const auto position = position_units(sector, sector.probes[p]);
        const auto size = [&] { return static_cast<std::uint16_t>(random.between(1000, 65535)); };
        // Around the probe: it stands 500 units from the origin's corner.
        Interior interior = box_interior({position[0] - 500, position[1] - 500, position[2] - 500}, {0, 0, 0},
                                         {size(), size(), size()});
        interior.shift = static_cast<std::uint8_t>(random.between(0, max_interior_shift));
        interior.probe = p;
        sector.interiors.push_back(interior);
    }
    return sector;
}

Sector random_sector_1_3(std::uint32_t seed, std::size_t probe_count) {
    Sector sector = random_sector_1_2(seed, probe_count);
    if (probe_count == 0)
        return sector;
    Random random(seed + 3000);
    const std::int64_t groups = random.between(1, std::int64_t{max_light_groups});
    Quality& quality = sector.quality.emplace();
    quality.buried_cells = random.any<std::uint32_t>();
    quality.blind_cells = random.any<std::uint32_t>();
    const auto error = [&] { return static_cast<float>(random.between(0, 1 << 20)) / (1 << 16); };
    const auto flag = [&] { return random.between(0, 1) == 1; };
    for (std::size_t p = 0; p < probe_count; ++p) {
        const auto paths = random.any<std::uint32_t>();
        const auto back_hits = random.any<std::uint32_t>();
        quality.probes.push_back({error(), error(), error(), paths, back_hits, flag(), flag(), flag()});
    }
    for (std::int64_t g = 0; g < groups; ++g) {
        // In order, of 1 to 63 bytes.
        LightGroup& group = sector.light_groups.emplace_back();
        group.name = std::string(1, static_cast<char>('a' + g));
        group.name.resize(static_cast<std::size_t>(random.between(1, std::int64_t{max_light_group_name})),
                          '_');
        std::vector<float>& errors = quality.group_errors.emplace_back();
        for (std::size_t p = 0; p < probe_count; ++p) {
            group.irradiance.push_back(random_irradiance(random));
            errors.push_back(error());
        }
    }
    constexpr std::array<std::size_t, 6> source_counts = {256, 257, 384, 385, 751, 2040};
    const std::size_t sources = source_counts[seed % source_counts.size()];
    sector.local_transfer = random_local_transfer(random, probe_count, neighbouring_sources(sources));
    return sector;
}

}  // namespace drtv::test
