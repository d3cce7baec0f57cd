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

}  // namespace drtv::test
