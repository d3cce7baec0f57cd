#include "bakerd/bake/footprint.h"

#include "bakerd/bake/stored_bytes.h"

#include <drtv/sector.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <type_traits>

namespace drtv::bake {
namespace {

// By measurement (CHANGELOG): finer cells do not fit into the record, coarser ones bake sectors again without need. Height tells most: rays pass above
// what stands on the ground.
constexpr std::int32_t least_cell_m = 16, least_layer_m = 4;
constexpr std::int32_t most_columns = 80, most_layers = 48;
// New things may stand as much higher than all others before they are beyond the grid.
constexpr float headroom_m = 16;
// Farther away hardly a thing is so large that later rays of a probe find it by more than the tolerance.
constexpr double near_m = 64;

constexpr int least_weight_exponent = -14;

constexpr std::uint64_t magic = 0x32'50'46'56'54'52'44;  // "DRTVFP2"
constexpr std::uint32_t most_rays = 1u << 16;
constexpr std::uint64_t most_probes = no_probe;
constexpr std::int32_t most_place = 1 << 24;

template <class Probes, class Visit>
void for_each_column(Probes& probes, Visit visit) {
    const auto each = [&](auto member) {
        for (auto& probe : probes) visit(probe.*member);
    };
    each(&ProbeRecord::position);
    each(&ProbeRecord::rays);
    each(&ProbeRecord::shadow_rays);
    each(&ProbeRecord::back_hits);
    each(&ProbeRecord::error);
    each(&ProbeRecord::bound);
}

// Two codes in a byte.
std::vector<std::uint8_t> in_pairs(const std::vector<std::uint8_t>& codes) {
    std::vector<std::uint8_t> pairs((codes.size() + 1) / 2, 0);
    for (std::size_t n = 0; n < codes.size(); ++n) pairs[n / 2] = static_cast<std::uint8_t>(pairs[n / 2] | codes[n] << (n % 2 * 4));
    return pairs;
}

std::vector<std::uint8_t> from_pairs(const std::vector<std::uint8_t>& pairs) {
    std::vector<std::uint8_t> codes;
    for (const std::uint8_t pair : pairs) {
        codes.push_back(pair & 15);
        codes.push_back(pair >> 4);
    }
    return codes;
}

bool is_sound(const FootprintGrid& grid) {
    const auto within = [](std::int32_t value, std::int32_t least, std::int32_t most) { return value >= least && value <= most; };
    const bool near_inside = within(grid.near_i, 0, grid.columns) && within(grid.near_j, 0, grid.rows) && within(grid.near_columns, 0, grid.columns - grid.near_i) && within(grid.near_rows, 0, grid.rows - grid.near_j);
    return near_inside && within(grid.cell_m, 1, 1 << 20) && within(grid.layer_m, 1, 1 << 20) && within(grid.columns, 1, 1024) && within(grid.rows, 1, 1024) && within(grid.layers, 1, 64) && within(grid.x, -most_place, most_place) &&
           within(grid.y, -most_place, most_place) && within(grid.z, -most_place, most_place);
}

// The bytes of a column's layers.
std::size_t bytes_of_column(const FootprintGrid& grid) { return (static_cast<std::size_t>(grid.layers) + 7) / 8; }

}  // namespace

FootprintGrid footprint_grid(map::SectorCoordinate sector, float distance_m, float low_m, float high_m) {
    const double side_m = map::sector_size_m;
    FootprintGrid grid;
    grid.cell_m = least_cell_m;
    while (side_m + 2 * double{distance_m} > static_cast<double>(most_columns - 2) * grid.cell_m) grid.cell_m *= 2;
    const auto first = [&](std::int32_t s, double around_m) { return static_cast<std::int32_t>(std::floor((s * side_m - around_m) / grid.cell_m)); };
    const auto end = [&](std::int32_t s, double around_m) { return static_cast<std::int32_t>(std::ceil(((s + 1) * side_m + around_m) / grid.cell_m)); };
    grid.x = first(sector.i, distance_m);
    grid.y = first(sector.j, distance_m);
    grid.columns = end(sector.i, distance_m) - grid.x;
    grid.rows = end(sector.j, distance_m) - grid.y;
    const double near = std::min<double>(near_m, distance_m);
    grid.near_i = first(sector.i, near) - grid.x;
    grid.near_j = first(sector.j, near) - grid.y;
    grid.near_columns = end(sector.i, near) - grid.x - grid.near_i;
    grid.near_rows = end(sector.j, near) - grid.y - grid.near_j;
    if (!(low_m < high_m)) low_m = high_m = 0;
    low_m -= headroom_m;
    high_m += headroom_m;
    grid.layer_m = least_layer_m;
    while (high_m - low_m > static_cast<float>((most_layers - 2) * grid.layer_m)) grid.layer_m *= 2;
    grid.z = static_cast<std::int32_t>(std::floor(low_m / static_cast<float>(grid.layer_m)));
    grid.layers = static_cast<std::int32_t>(std::ceil(high_m / static_cast<float>(grid.layer_m))) - grid.z;
    return grid;
}

std::size_t patch_of(map::SectorCoordinate sector, const placement::Position& probe) {
    constexpr std::int64_t side = 4, sector_units = placement::sector_size_m * placement::units_per_m, patch_units = sector_units / side;
    // Wherever it stands: it need only be the same each time.
    const auto along = [](std::int64_t units, std::int64_t s) { return static_cast<std::size_t>(std::clamp<std::int64_t>((units - s * sector_units) / patch_units, 0, side - 1)); };
    return along(probe.y, sector.j) * side + along(probe.x, sector.i);
}

std::uint8_t weight_code(float weight) {
    if (!(weight > 0)) return 0;
    // Exponent and first digit of the mantissa, the rest rounded up: 2^-14 is 1, and 1.5 times as much 2.
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(weight) + 0x3FFFFF;
    const std::int32_t code = static_cast<std::int32_t>(bits >> 22) - 2 * (127 + least_weight_exponent) + 1;
    return static_cast<std::uint8_t>(std::clamp<std::int32_t>(code, 1, most_weight_code));
}

float weight_of_code(std::uint8_t code) {
    if (code == 0) return 0;
    if (code >= most_weight_code) return 1;
    return std::bit_cast<float>(static_cast<std::uint32_t>(code - 1 + 2 * (127 + least_weight_exponent)) << 22);
}

std::vector<std::uint8_t> encode_footprint(const Footprint& footprint) {
    StoredWriter writer;
    writer.add(magic);
    writer.add(footprint.sector);
    writer.add(footprint.reach_m);
    writer.add(footprint.rays);
    writer.add(footprint.without_bounds);
    writer.add(footprint.static_gain);
    writer.add(footprint.placement_m);
    writer.add(footprint.min_distance_m);
    writer.add(static_cast<std::uint64_t>(footprint.probes.size()));
    // Kind by kind: like stands beside like.
    for_each_column(footprint.probes, [&](const auto& value) { writer.add(value); });
    writer.add(footprint.grid);
    for (const std::uint64_t column : footprint.crossed) {
        for (std::size_t byte = 0; byte < bytes_of_column(footprint.grid); ++byte) writer.add(static_cast<std::uint8_t>(column >> 8 * byte));
    }
    writer.add_all(in_pairs(footprint.weights));
    // Axis by axis, as differences: neighbours of a lattice are alike.
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        std::vector<std::int32_t> differences;
        std::int32_t before = 0;
        for (const SolidTest& test : footprint.solid_tests) {
            differences.push_back(static_cast<std::int32_t>(static_cast<std::uint32_t>(test.position[axis]) - static_cast<std::uint32_t>(before)));
            before = test.position[axis];
        }
        writer.add_all(differences);
    }
    std::vector<std::uint8_t> to_flip;
    for (const SolidTest& test : footprint.solid_tests) to_flip.push_back(test.to_flip);
    writer.add_all(to_flip);
    return writer.compressed();
}

std::optional<Footprint> decode_footprint(std::span<const std::uint8_t> bytes) {
    StoredReader reader(bytes);
    if (reader.read<std::uint64_t>() != magic) return std::nullopt;
    Footprint footprint;
    footprint.sector = reader.read<map::SectorCoordinate>();
    footprint.reach_m = reader.read<float>();
    footprint.rays = reader.read<std::uint32_t>();
    footprint.without_bounds = reader.read<std::uint8_t>() != 0;
    footprint.static_gain = reader.read<float>();
    footprint.placement_m = reader.read<float>();
    footprint.min_distance_m = reader.read<float>();
    const auto probes = reader.read<std::uint64_t>();
    if (probes > most_probes) return std::nullopt;
    footprint.probes.resize(probes);
    for_each_column(footprint.probes, [&](auto& value) { value = reader.read<std::remove_reference_t<decltype(value)>>(); });
    footprint.grid = reader.read<FootprintGrid>();
    if (!reader.sound() || !is_sound(footprint.grid)) return std::nullopt;
    footprint.crossed.resize(footprint.grid.column_count());
    for (std::uint64_t& column : footprint.crossed) {
        for (std::size_t byte = 0; byte < bytes_of_column(footprint.grid); ++byte) column |= std::uint64_t{reader.read<std::uint8_t>()} << 8 * byte;
    }
    footprint.weights = from_pairs(reader.read_all<std::uint8_t>());
    std::array<std::vector<std::int32_t>, 3> differences;
    for (auto& axis : differences) axis = reader.read_all<std::int32_t>();
    const auto to_flip = reader.read_all<std::uint8_t>();
    if (!reader.complete() || footprint.rays == 0 || footprint.rays > most_rays) return std::nullopt;
    for (const auto& axis : differences) {
        if (axis.size() != to_flip.size()) return std::nullopt;
    }
    // Codes come in pairs: of an odd number of them one is too many.
    const std::size_t weights = Footprint::weight_count(footprint.grid);
    if (footprint.weights.size() != weights + weights % 2) return std::nullopt;
    footprint.weights.resize(weights);
    glm::uvec3 position(0);  // odd bytes may wrap around
    for (std::size_t n = 0; n < to_flip.size(); ++n) {
        position += glm::uvec3(glm::ivec3(differences[0][n], differences[1][n], differences[2][n]));
        footprint.solid_tests.push_back({placement::Position(position), to_flip[n]});
    }
    return footprint;
}

}  // namespace drtv::bake
