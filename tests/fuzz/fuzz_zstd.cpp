// Compressed sections: the first bytes choose a section, the rest are its stored bytes, in a file whose checksums are right. Whatever
// decodes must decode to what the page says: its raw bytes, stored raw, give the same sector.
#include "tests/format/sector_bytes.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/write.h>

#include <cstdlib>

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace drtv::test;
    static const Bytes good = golden_bytes_1_2();
    constexpr std::size_t head_bytes = 4;
    if (size < head_bytes) return 0;
    std::vector<Section> sections = sections_of(good);
    Section& section = sections[data[0] % sections.size()];
    section.codec = section.kind == 8 && data[1] % 2 == 1 ? 2 : 1;
    section.version = section.codec;
    section.raw_bytes += static_cast<std::uint32_t>(static_cast<std::int8_t>(data[2])) * 24;
    section.stored.assign(data + head_bytes, data + size);
    const Bytes file = with_sections(good, sections);

    drtv::Sector sector;
    const drtv::ReadStatus status = drtv::read_sector(file, sector);
    require(status.ok() == drtv::validate_sector(file, {.quick = true}).valid());
    if (!status.ok()) return 0;
    drtv::Sector again;
    require(drtv::read_sector(drtv::write_sector(sector), again).ok());
    require(again == sector);
    return 0;
}
