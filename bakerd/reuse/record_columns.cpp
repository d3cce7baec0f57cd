#include "bakerd/reuse/record_columns.h"

namespace drtv::reuse {
namespace {

// Zigzag: small differences of either sign have empty upper bytes.
std::uint32_t zigzag(std::uint32_t difference) {
    return difference << 1 ^ (0 - (difference >> 31));
}

std::uint32_t undo_zigzag(std::uint32_t value) {
    return value >> 1 ^ (0 - (value & 1));
}

}  // namespace

void add_column(RecordWriter& writer, std::span<const std::uint32_t> numbers, Neighbours neighbours) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
        std::uint32_t before = 0;
        for (const std::uint32_t number : numbers) {
            const std::uint32_t value = neighbours == Neighbours::alike ? zigzag(number - before) : number;
            writer.add(static_cast<std::uint8_t>(value >> shift));
            before = number;
        }
    }
}

std::vector<std::uint32_t> read_column(RecordReader& reader, std::size_t count, Neighbours neighbours) {
    std::vector<std::uint32_t> numbers(count);
    for (unsigned shift = 0; shift < 32; shift += 8) {
        for (std::uint32_t& number : numbers)
            number |= std::uint32_t{reader.read<std::uint8_t>()} << shift;
    }
    if (neighbours == Neighbours::unrelated)
        return numbers;
    std::uint32_t before = 0;
    for (std::uint32_t& number : numbers) {
        before += undo_zigzag(number);
        number = before;
    }
    return numbers;
}

}  // namespace drtv::reuse
