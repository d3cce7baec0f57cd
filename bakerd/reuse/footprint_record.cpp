#include "bakerd/reuse/footprint_record.h"

#include "bakerd/reuse/record_bytes.h"
#include "bakerd/reuse/record_columns.h"

#include <drtv/sector.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

namespace drtv::reuse {
namespace {

using placement::SolidTest;

constexpr std::uint64_t magic = 0x50'46'56'54'52'44;  // "DRTVFP"
constexpr std::uint32_t max_rays = 1u << 16;
constexpr std::int32_t max_place = 1 << 18;

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

// Calls visit(record -> member, how the members of neighbours relate) for each member of a record.
template <class Record, class Visit>
void visit_position(Visit visit) {
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        const auto coordinate = [axis](auto& record) -> auto& {
            return record.position[axis];
        };
        visit(coordinate, Neighbours::alike);
    }
}

template <class Visit>
void visit_members(const std::vector<ProbeRecord>&, Visit visit) {
    visit_position<ProbeRecord>(visit);
    visit(std::mem_fn(&ProbeRecord::rays), Neighbours::alike);
    visit(std::mem_fn(&ProbeRecord::shadow_rays), Neighbours::alike);
    visit(std::mem_fn(&ProbeRecord::error), Neighbours::unrelated);
    visit(std::mem_fn(&ProbeRecord::changed_weight), Neighbours::unrelated);
}

template <class Visit>
void visit_members(const std::vector<SolidTest>&, Visit visit) {
    visit_position<SolidTest>(visit);
    visit(std::mem_fn(&SolidTest::to_flip), Neighbours::unrelated);
}

constexpr std::size_t stored_bytes = sizeof(std::uint32_t);  // of each member
static_assert(sizeof(ProbeRecord) == 7 * stored_bytes && sizeof(SolidTest) == 4 * stored_bytes);

template <class Record>
void add_records(RecordWriter& writer, const std::vector<Record>& records) {
    writer.add(static_cast<std::uint32_t>(records.size()));
    visit_members(records, [&](const auto& member, Neighbours neighbours) {
        std::vector<std::uint32_t> numbers;
        for (const Record& record : records)
            numbers.push_back(as_bits(member(record)));
        add_column(writer, numbers, neighbours);
    });
}

template <class Record>
std::vector<Record> read_records(RecordReader& reader) {
    const auto count = reader.read<std::uint32_t>();
    if (count > reader.left() / sizeof(Record)) {
        reader.refuse();
        return {};
    }
    std::vector<Record> records(count);
    visit_members(records, [&](const auto& member, Neighbours neighbours) {
        const std::vector<std::uint32_t> numbers = read_column(reader, count, neighbours);
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

void write_crossed(RecordWriter& writer, const Footprint& footprint) {
    for (std::size_t byte = 0; byte < bytes_of_column(footprint.grid); ++byte) {
        for (const std::uint64_t column : footprint.crossed)
            writer.add(static_cast<std::uint8_t>(column >> 8 * byte));
    }
}

// Weights below a code count as that.
std::vector<std::uint8_t> encode_with(const Footprint& footprint, std::uint8_t min_code) {
    RecordWriter writer;
    writer.add(magic);
    writer.add(footprint_version);
    writer.add(footprint.sector);
    writer.add(footprint.reach_m);
    writer.add(footprint.rays);
    writer.add(footprint.without_bounds);
    writer.add(footprint.static_gain);
    writer.add(footprint.max_scattered);
    writer.add(footprint.placement_m);
    writer.add(footprint.placement);
    add_records(writer, footprint.probes);
    writer.add(footprint.grid);
    write_crossed(writer, footprint);
    std::vector<std::uint8_t> weights;
    for (const std::size_t block : crossed_blocks(footprint)) {
        for (std::size_t quarter = 0; quarter < quarter_count; ++quarter) {
            const std::uint8_t code = footprint.weight(block, quarter);
            weights.push_back(code == 0 ? code : std::max(code, min_code));
        }
    }
    writer.add_all(in_pairs(weights));
    add_records(writer, footprint.solid_tests);
    writer.add_texts(footprint.placement_warnings);
    return writer.compressed();
}

bool is_sound(const FootprintGrid& grid) {
    const auto within = [](std::int32_t value, std::int32_t least, std::int32_t most) {
        return value >= least && value <= most;
    };
    const auto is_place = [&](std::int32_t cell) { return within(cell, -max_place, max_place); };
    const bool has_cells = within(grid.cell_m, 1, 1 << 12) && within(grid.layer_m, 1, 1 << 12);
    const bool has_columns = within(grid.columns, 1, 1024) && within(grid.rows, 1, 1024);
    return has_cells && has_columns && within(grid.layers, 1, 64) && is_place(grid.x) && is_place(grid.y) &&
           is_place(grid.z);
}

// All but the grid, and what lies in its cells.
bool is_sound(const Footprint& footprint) {
    const auto sensible = [](float value) { return value >= 0 && std::isfinite(value); };
    const bool has_rays = footprint.rays > 0 && footprint.rays <= max_rays;
    const bool has_lengths = sensible(footprint.reach_m) && sensible(footprint.placement_m);
    const bool has_light = sensible(footprint.static_gain) && footprint.max_scattered > 0 &&
                           std::isfinite(footprint.max_scattered);
    const auto has_weight = [&](const ProbeRecord& probe) { return sensible(probe.changed_weight); };
    return has_rays && has_lengths && has_light && footprint.probes.size() <= max_probes &&
           std::ranges::all_of(footprint.probes, has_weight);
}

void read_crossed(RecordReader& reader, Footprint& footprint) {
    footprint.crossed.resize(footprint.grid.column_count());
    for (std::size_t byte = 0; byte < bytes_of_column(footprint.grid); ++byte) {
        for (std::uint64_t& column : footprint.crossed)
            column |= std::uint64_t{reader.read<std::uint8_t>()} << 8 * byte;
    }
    for (std::uint64_t& column : footprint.crossed)
        column &= layers_between(0, footprint.grid.layers - 1);
}

}  // namespace

std::vector<std::uint8_t> encode_footprint(const Footprint& footprint) {
    const auto fits = [](const std::vector<std::uint8_t>& bytes) { return bytes.size() <= max_record_bytes; };
    std::vector<std::uint8_t> bytes = encode_with(footprint, 1);
    if (fits(bytes) || !fits(encode_with(footprint, max_weight_code)))
        return bytes;
    for (std::uint8_t least = 2; !fits(bytes); ++least)
        bytes = encode_with(footprint, least);
    return bytes;
}

std::optional<Footprint> decode_footprint(std::span<const std::uint8_t> bytes) {
    RecordReader reader(bytes);
    if (reader.read<std::uint64_t>() != magic || reader.read<std::uint32_t>() != footprint_version)
        return std::nullopt;
    Footprint footprint;
    footprint.sector = reader.read<map::SectorCoordinate>();
    footprint.reach_m = reader.read<float>();
    footprint.rays = reader.read<std::uint32_t>();
    footprint.without_bounds = reader.read<std::uint8_t>() != 0;
    footprint.static_gain = reader.read<float>();
    footprint.max_scattered = reader.read<float>();
    footprint.placement_m = reader.read<float>();
    footprint.placement = reader.read<map::Digest>();
    footprint.probes = read_records<ProbeRecord>(reader);
    footprint.grid = reader.read<FootprintGrid>();
    if (!reader.sound() || !is_sound(footprint.grid))
        return std::nullopt;
    read_crossed(reader, footprint);
    const std::vector<std::uint8_t> weights = from_pairs(reader.read_all<std::uint8_t>());
    footprint.solid_tests = read_records<SolidTest>(reader);
    footprint.placement_warnings = reader.read_texts();
    if (!reader.complete() || !is_sound(footprint))
        return std::nullopt;
    const std::vector<std::size_t> blocks = crossed_blocks(footprint);
    if (weights.size() != blocks.size() * quarter_count)
        return std::nullopt;
    footprint.weights.resize(footprint.grid.block_count() * quarter_count);
    for (std::size_t n = 0; n < weights.size(); ++n)
        footprint.weights[blocks[n / quarter_count] * quarter_count + n % quarter_count] = weights[n];
    return footprint;
}

}  // namespace drtv::reuse
