#include "tests/format/sectors.h"

#include <random>

namespace drtv::test {
namespace {

using Row = Float4;

std::array<std::int16_t, sh_count> codes(const Row& row, float factor) {
    std::array<std::int16_t, sh_count> q{};
    for (std::size_t i = 0; i < sh_count; ++i) q[i] = encode_fixed(row[i] * factor, transfer_scale);
    return q;
}

// Over an endless plane of albedo 1 (SPEC.md, section 8): the share of each lobe that meets it, times (Y0, 0, 2/3 Y1, 0).
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

}  // namespace

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
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) sector.grid.cells[cell] = cell % grid_size < 8 ? 0 : 1;
    sector.bake.rays = 2048;
    sector.bake.bounces = 3;
    sector.bake.reach_m = 512;
    sector.bake.min_distance_m = 6;
    for (std::size_t n = 0; n < 32; ++n) sector.bake.settings_key[n] = static_cast<std::uint8_t>(n);
    sector.statistics = {9, 1, 2, 3, 4, 7.5f, 12288, 5};
    return sector;
}

Sector golden_sector_1_1() {
    Sector sector = golden_sector();
    Probe& leaves = sector.probes.emplace_back(sector.probes[1]);
    leaves.position = {49152, 49152, 512};
    leaves.kind = ProbeKind::vegetation;
    sector.static_irradiance = {{{{{16384, 8192, 4096, 32767}, {1, 2, 3, 4}, {0, 0, 0, 1}}}, 0},
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

std::vector<LocalSource> neighbouring_sources(std::size_t probes) {
    std::vector<LocalSource> sources;
    for (std::size_t n = 0; n < probes; ++n) sources.push_back({1, 0, static_cast<std::uint8_t>(n), 0});
    return sources;
}

void add_pairs(LocalTransfer& local, std::size_t p, const std::vector<std::size_t>& sources, const LightCodes& codes) {
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
    sector.z_origin_units = static_cast<std::int32_t>(random.between(-max_z_origin_units, max_z_origin_units));
    sector.z_shift = static_cast<std::uint8_t>(random.between(0, max_z_shift));
    for (std::size_t p = 0; p < probe_count; ++p) {
        Probe probe;
        // Distinct in x: no two probes stand at one place.
        probe.position = {static_cast<std::uint16_t>(256 * p + random.any<std::uint8_t>()), random.any<std::uint16_t>(), random.any<std::uint16_t>()};
        probe.kind = static_cast<ProbeKind>(random.between(0, 2));
        for (auto& channel : probe.transfer) {
            for (auto& row : channel) {
                row[0] = static_cast<std::int16_t>(random.between(-18487, 18487));
                for (std::size_t i = 1; i < sh_count; ++i) row[i] = static_cast<std::int16_t>(random.between(-32026, 32026));
            }
        }
        for (std::size_t b = 0; b < 3; ++b) probe.sky_visibility[b] = static_cast<std::int16_t>(random.between(0, 32767));
        sector.probes.push_back(probe);
    }
    sector.grid.z_origin_units = static_cast<std::int32_t>(random.between(-max_z_origin_units, max_z_origin_units));
    sector.grid.cell_height_units = static_cast<std::uint32_t>(random.between(1, max_cell_height_units));
    for (std::uint8_t& cell : sector.grid.cells) {
        cell = probe_count == 0 ? no_probe : static_cast<std::uint8_t>(random.between(0, static_cast<std::int64_t>(probe_count) - 1));
    }
    sector.bake.rays = static_cast<std::uint32_t>(random.between(1, UINT32_MAX));
    sector.bake.bounces = random.any<std::uint32_t>();
    sector.bake.reach_m = static_cast<float>(random.between(1, 1 << 20)) / 64;
    sector.bake.min_distance_m = static_cast<float>(random.between(1, 1 << 20)) / 64;
    for (std::uint8_t& byte : sector.bake.settings_key) byte = random.any<std::uint8_t>();
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
    const auto code = [&](std::int64_t least, std::int64_t most) { return static_cast<std::int16_t>(random.between(least, most)); };
    for (std::size_t p = 0; p < probe_count; ++p) {
        StaticIrradiance& light = sector.static_irradiance.emplace_back();
        for (auto& channel : light.codes) {
            for (std::int16_t& q : channel) q = code(0, 32767);
        }
        light.exponent = static_cast<std::int8_t>(random.between(-64, 64));
    }
    LocalTransfer& local = sector.local_transfer.emplace();
    // Both widths of the masks, and the ends of both.
    constexpr std::array<std::int64_t, 6> source_counts = {0, 1, 127, 128, 129, 255};
    local.sources = neighbouring_sources(static_cast<std::size_t>(source_counts[seed % source_counts.size()]));
    local.receivers.resize(probe_count);
    for (LocalSource& source : local.sources) {
        source.dj = static_cast<std::int8_t>(random.between(-1, 1));
        source.exponent = static_cast<std::int8_t>(random.between(-30, 31));
    }
    for (std::size_t p = 0; p < probe_count; ++p) {
        local.receivers[p].exponent = static_cast<std::int8_t>(random.between(-96, 32));
        std::size_t left = max_local_sources;
        for (std::size_t s = 0; s < local.sources.size() && left > 0; ++s) {
            if (random.between(0, 2) == 0) continue;
            LightCodes codes;
            for (auto& channel : codes) {
                channel[0] = code(0, 28000);
                for (std::size_t i = 1; i < sh_count; ++i) channel[i] = code(-channel[0], channel[0]);
            }
            add_pairs(local, p, {s}, codes);
            --left;
        }
    }
    const auto error = [&](float least) { return least + static_cast<float>(random.between(0, 1 << 20)) / (1 << 20); };
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

}  // namespace drtv::test
