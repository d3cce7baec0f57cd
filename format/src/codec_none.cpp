#include "codec.h"

#include "read_failure.h"
#include "section_table.h"

namespace drtv {

ReadStatus unpack_section(const PackedSection& packed, std::vector<std::uint8_t>& /*raw*/) {
    return fail(ReadError::compressed,
                packed.entry.offset,
                section_name(packed.entry),
                " is compressed, and this library was built without zstd");
}

std::vector<std::uint8_t> pack_section(std::span<const std::uint8_t> /*raw*/,
                                       bool /*filtered*/,
                                       std::size_t /*probe_count*/) {
    return {};
}

}  // namespace drtv
