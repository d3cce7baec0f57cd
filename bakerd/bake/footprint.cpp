#include "bakerd/bake/footprint.h"

#include "bakerd/bake/stored_bytes.h"

#include <drtv/sector.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace drtv::bake {
namespace {

// By measurement (CHANGELOG): finer cells do not fit into the record, coarser ones bake sectors again without
// need. Height tells most: rays pass above what stands on the ground.
constexpr std::int32_t least_cell_m = 16, least_layer_m = 8;
constexpr std::int32_t most_columns = 80, most_layers = 48;
// New things may stand as much higher than all others before they are beyond the grid.
constexpr float headroom_m = 16;

constexpr float half_octave = std::numbers::sqrt2_v<float>;
constexpr std::array<float, most_weight_code - 1> weight_levels = {0x1p-12f,
                                                                   0x1p-12f * half_octave,
                                                                   0x1p-11f,
                                                                   0x1p-11f * half_octave,
                                                                   0x1p-10f,
                                                                   0x1p-10f * half_octave,
                                                                   0x1p-9f,
                                                                   0x1p-9f * half_octave,
                                                                   0x1p-8f,
                                                                   0x1p-7f,
                                                                   0x1p-6f,
                                                                   0x1p-5f,
                                                                   0x1p-4f,
                                                                   0x1p-3f};

constexpr std::uint64_t magic = 0x50'46'56'54'52'44;  // "DRTVFP"
constexpr std::uint32_t most_rays = 1u << 16;
constexpr std::int32_t most_place = 1 << 18;

template <class Number>
std::uint32_t as_bits(const Number& number) {
    if constexpr (sizeof number == sizeof(std::uint32_t))
        return std::bit_cast<std::uint32_t>(number);
    else
        return number;
}

template <class Number>
void set_bits(Number& number, std::uint32_t bits) {
    if constexpr (sizeof number == sizeof bits)
        number = std::bit_cast<Number>(bits);
    else
        number = static_cast<Number>(bits);
}

// Numbers of one kind, byte by byte: like stands beside like. Those of neighbours differ by little.
void add_numbers(StoredWriter& writer, std::span<const std::uint32_t> numbers, bool as_differences) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
        std::uint32_t before = 0;
        for (const std::uint32_t number : numbers) {
            // Zigzag: small ones of either sign have empty upper bytes.
            const std::uint32_t difference = number - before,
                                value = as_differences ? difference << 1 ^ (0 - (difference >> 31)) : number;
            writer.add(static_cast<std::uint8_t>(value >> shift));
            before = number;
        }
    }
}

std::vector<std::uint32_t> read_numbers(StoredReader& reader, std::size_t count, bool as_differences) {
    std::vector<std::uint32_t> numbers(count);
    for (unsigned shift = 0; shift < 32; shift += 8) {
        for (std::uint32_t& number : numbers)
            number |= std::uint32_t{reader.read<std::uint8_t>()} << shift;
    }
    std::uint32_t before = 0;
    for (std::uint32_t& number : numbers) {
        if (as_differences)
            number = before += number >> 1 ^ (0 - (number & 1));
        else
            before = number;
    }
    return numbers;
}

// Visits each column of a list of records: (member of a record, whether neighbours differ by little).
template <class Visit>
void for_each_column(const std::vector<ProbeRecord>*, Visit visit) {
    for (glm::length_t axis = 0; axis < 3; ++axis)
        visit(
            [axis](auto& probe) -> auto& { return probe.position[axis]; }, true);
    visit(
        [](auto& probe) -> auto& { return probe.rays; }, true);
    visit(
        [](auto& probe) -> auto& { return probe.shadow_rays; }, true);
    visit(
        [](auto& probe) -> auto& { return probe.back_hits; }, false);
    visit(
        [](auto& probe) -> auto& { return probe.error; }, false);
    visit(
        [](auto& probe) -> auto& { return probe.share; }, false);
}

template <class Visit>
void for_each_column(const std::vector<SolidTest>*, Visit visit) {
    for (glm::length_t axis = 0; axis < 3; ++axis)
        visit(
            [axis](auto& test) -> auto& { return test.position[axis]; }, true);
    visit(
        [](auto& test) -> auto& { return test.to_flip; }, false);
}

static_assert(sizeof(ProbeRecord) == 8 * sizeof(std::uint32_t) &&
                  sizeof(SolidTest) == 4 * sizeof(std::uint32_t),
              "each member is stored as 32 bits");

template <class Record>
void add_records(StoredWriter& writer, const std::vector<Record>& records) {
    writer.add(static_cast<std::uint32_t>(records.size()));
    for_each_column(&records, [&](auto member, bool as_differences) {
        std::vector<std::uint32_t> numbers;
        for (const Record& record : records)
            numbers.push_back(as_bits(member(record)));
        add_numbers(writer, numbers, as_differences);
    });
}

template <class Record>
std::vector<Record> read_records(StoredReader& reader) {
    const auto count = reader.read<std::uint32_t>();
    if (count > reader.left() / sizeof(Record)) {
        reader.refuse();
        return {};
    }
    std::vector<Record> records(count);
    for_each_column(&records, [&](auto member, bool as_differences) {
        const std::vector<std::uint32_t> numbers = read_numbers(reader, count, as_differences);
        for (std::size_t n = 0; n < count; ++n)
            set_bits(member(records[n]), numbers[n]);
    });
    return records;
}

// Two codes in a byte.
std::vector<std::uint8_t> in_pairs(const std::vector<std::uint8_t>& codes) {
    std::vector<std::uint8_t> pairs((codes.size() + 1) / 2, 0);
    for (std::size_t n = 0; n < codes.size(); ++n)
        pairs[n / 2] = static_cast<std::uint8_t>(pairs[n / 2] | codes[n] << (n % 2 * 4));
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
    const auto within = [](std::int32_t value, std::int32_t least, std::int32_t most) {
        return value >= least && value <= most;
    };
    return within(grid.cell_m, 1, 1 << 12) && within(grid.layer_m, 1, 1 << 12) &&
           within(grid.columns, 1, 1024) && within(grid.rows, 1, 1024) && within(grid.layers, 1, 64) &&
           within(grid.x, -most_place, most_place) && within(grid.y, -most_place, most_place) &&
           within(grid.z, -most_place, most_place);
}

// The bytes of a column's layers.
std::size_t bytes_of_column(const FootprintGrid& grid) {
    return (static_cast<std::size_t>(grid.layers) + 7) / 8;
}

// Only these have weights.
std::vector<std::size_t> crossed_blocks(const Footprint& footprint) {
    const FootprintGrid& grid = footprint.grid;
    std::vector<bool> crossed(grid.block_count());
    for (std::int32_t j = 0; j < grid.rows; ++j) {
        for (std::int32_t i = 0; i < grid.columns; ++i) {
            for (std::uint64_t layers = footprint.crossed[grid.column(i, j)]; layers != 0;
                 layers &= layers - 1)
                crossed[grid.block(i, j, std::countr_zero(layers))] = true;
        }
    }
    std::vector<std::size_t> blocks;
    for (std::size_t block = 0; block < crossed.size(); ++block) {
        if (crossed[block])
            blocks.push_back(block);
    }
    return blocks;
}

}  // namespace

FootprintGrid footprint_grid(map::SectorCoordinate sector, float distance_m, float low_m, float high_m) {
    const double side_m = map::sector_size_m;
    FootprintGrid grid;
    grid.cell_m = least_cell_m;
    while (side_m + 2 * double{distance_m} > static_cast<double>(most_columns - 2) * grid.cell_m)
        grid.cell_m *= 2;
    const auto first = [&](std::int32_t s) {
        return static_cast<std::int32_t>(std::floor((s * side_m - double{distance_m}) / grid.cell_m));
    };
    const auto end = [&](std::int32_t s) {
        return static_cast<std::int32_t>(std::ceil(((s + 1) * side_m + double{distance_m}) / grid.cell_m));
    };
    grid.x = first(sector.i);
    grid.y = first(sector.j);
    grid.columns = end(sector.i) - grid.x;
    grid.rows = end(sector.j) - grid.y;
    if (!(low_m < high_m))
        low_m = high_m = 0;
    low_m -= headroom_m;
    high_m += headroom_m;
    // A block is at least as high as a cell is wide: from a point of a ray to the next it is one block at
    // most (footprint_recorder.cpp).
    grid.layer_m = std::max(least_layer_m, grid.cell_m / 2);
    while (high_m - low_m > static_cast<float>((most_layers - 2) * grid.layer_m))
        grid.layer_m *= 2;
    grid.z = static_cast<std::int32_t>(std::floor(low_m / static_cast<float>(grid.layer_m)));
    grid.layers = static_cast<std::int32_t>(std::ceil(high_m / static_cast<float>(grid.layer_m))) - grid.z;
    return grid;
}

std::size_t quarter_of(map::SectorCoordinate sector, const placement::Position& probe) {
    constexpr std::int64_t sector_units = placement::sector_size_m * placement::units_per_m;
    const auto upper = [](std::int64_t units, std::int64_t s) {
        return units >= s * sector_units + sector_units / 2 ? std::size_t{1} : std::size_t{0};
    };
    return upper(probe.y, sector.j) * 2 + upper(probe.x, sector.i);
}

std::uint8_t weight_code(float weight) {
    if (!(weight > 0))
        return 0;
    return static_cast<std::uint8_t>(std::ranges::lower_bound(weight_levels, weight) - weight_levels.begin() +
                                     1);
}

float weight_of_code(std::uint8_t code) {
    if (code == 0)
        return 0;
    return code < most_weight_code ? weight_levels[std::size_t{code} - 1] : 1;
}

namespace {

// Weights below a code count as that.
std::vector<std::uint8_t> encode_with(const Footprint& footprint, std::uint8_t least_code) {
    StoredWriter writer;
    writer.add(magic);
    writer.add(footprint_version);
    writer.add(footprint.sector);
    writer.add(footprint.reach_m);
    writer.add(footprint.rays);
    writer.add(footprint.without_bounds);
    writer.add(footprint.static_gain);
    writer.add(footprint.most_scattered);
    writer.add(footprint.placement_m);
    writer.add(footprint.min_distance_m);
    add_records(writer, footprint.probes);
    writer.add(footprint.grid);
    for (std::size_t byte = 0; byte < bytes_of_column(footprint.grid); ++byte) {
        for (const std::uint64_t column : footprint.crossed)
            writer.add(static_cast<std::uint8_t>(column >> 8 * byte));
    }
    std::vector<std::uint8_t> weights;
    for (const std::size_t block : crossed_blocks(footprint)) {
        for (std::size_t quarter = 0; quarter < quarter_count; ++quarter) {
            const std::uint8_t code = footprint.weight(block, quarter);
            weights.push_back(code == 0 ? code : std::max(code, least_code));
        }
    }
    writer.add_all(in_pairs(weights));
    add_records(writer, footprint.solid_tests);
    return writer.compressed();
}

}  // namespace

std::vector<std::uint8_t> encode_footprint(const Footprint& footprint) {
    const auto fits = [](const std::vector<std::uint8_t>& bytes) {
        return bytes.size() <= most_record_bytes;
    };
    std::vector<std::uint8_t> bytes = encode_with(footprint, 1);
    if (fits(bytes) || !fits(encode_with(footprint, most_weight_code)))
        return bytes;
    for (std::uint8_t least = 2; !fits(bytes); ++least)
        bytes = encode_with(footprint, least);
    return bytes;
}

std::optional<Footprint> decode_footprint(std::span<const std::uint8_t> bytes) {
    StoredReader reader(bytes);
    if (reader.read<std::uint64_t>() != magic || reader.read<std::uint32_t>() != footprint_version)
        return std::nullopt;
    Footprint footprint;
    footprint.sector = reader.read<map::SectorCoordinate>();
    footprint.reach_m = reader.read<float>();
    footprint.rays = reader.read<std::uint32_t>();
    footprint.without_bounds = reader.read<std::uint8_t>() != 0;
    footprint.static_gain = reader.read<float>();
    footprint.most_scattered = reader.read<float>();
    footprint.placement_m = reader.read<float>();
    footprint.min_distance_m = reader.read<float>();
    footprint.probes = read_records<ProbeRecord>(reader);
    footprint.grid = reader.read<FootprintGrid>();
    if (!reader.sound() || !is_sound(footprint.grid))
        return std::nullopt;
    footprint.crossed.resize(footprint.grid.column_count());
    for (std::size_t byte = 0; byte < bytes_of_column(footprint.grid); ++byte) {
        for (std::uint64_t& column : footprint.crossed)
            column |= std::uint64_t{reader.read<std::uint8_t>()} << 8 * byte;
    }
    for (std::uint64_t& column : footprint.crossed)
        column &= layers_between(0, footprint.grid.layers - 1);
    const std::vector<std::uint8_t> weights = from_pairs(reader.read_all<std::uint8_t>());
    footprint.solid_tests = read_records<SolidTest>(reader);
    if (!reader.complete() || footprint.rays == 0 || footprint.rays > most_rays ||
        footprint.probes.size() > max_probes)
        return std::nullopt;
    const auto sensible = [](float value) { return value >= 0 && std::isfinite(value); };
    if (!sensible(footprint.reach_m) || !sensible(footprint.static_gain) ||
        !(footprint.most_scattered > 0 && std::isfinite(footprint.most_scattered)) ||
        !sensible(footprint.placement_m) || !sensible(footprint.min_distance_m))
        return std::nullopt;
    if (!std::ranges::all_of(footprint.probes,
                             [&](const ProbeRecord& probe) { return sensible(probe.share); }))
        return std::nullopt;
    const std::vector<std::size_t> blocks = crossed_blocks(footprint);
    if (weights.size() != blocks.size() * quarter_count)
        return std::nullopt;
    footprint.weights.resize(footprint.grid.block_count() * quarter_count);
    for (std::size_t n = 0; n < blocks.size(); ++n)
        std::copy_n(weights.begin() + static_cast<std::ptrdiff_t>(n * quarter_count),
                    quarter_count,
                    footprint.weights.begin() + static_cast<std::ptrdiff_t>(blocks[n] * quarter_count));
    return footprint;
}

}  // namespace drtv::bake
