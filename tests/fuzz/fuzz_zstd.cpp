// Compressed sections: the first bytes choose a section, the rest are its stored bytes, in a file whose
// checksums are right. Whatever decodes must survive being written raw and read again.
#include "tests/format/sector_bytes.h"

#include <drtv/read.h>
#include <drtv/write.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>

namespace {

using namespace drtv::test;

void require(bool holds) {
    if (!holds)
        std::abort();
}

// The golden file with each of its sections at the end in turn, empty, so that only what hangs on that one
// changes.
std::vector<Bytes> files_with_one_last() {
    const std::vector<Section> sections = sections_of(golden_bytes_1_3());
    std::vector<Bytes> files;
    for (std::size_t last = 0; last < sections.size(); ++last) {
        std::vector<Section> turned = sections;
        std::rotate(turned.begin() + static_cast<std::ptrdiff_t>(last),
                    turned.begin() + static_cast<std::ptrdiff_t>(last) + 1, turned.end());
        turned.back().stored.clear();
        files.push_back(with_sections(golden_bytes_1_3(), turned));
    }
    return files;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::vector<Bytes> files = files_with_one_last();
    constexpr std::size_t head_bytes = 4;
    if (size < head_bytes)
        return 0;
    Bytes file = files[data[0] % files.size()];
    const std::size_t at_entry = entry(files.size() - 1), table_end = entry(files.size());
    const bool filtered = get(file, at_entry + at::kind, 2) == 8 && data[1] % 2 == 1;
    const bool many_sources = data[1] / 2 % 2 == 1;
    const std::uint64_t raw_bytes = get(file, at_entry + at::raw_bytes, 4) +
                                    static_cast<std::uint64_t>(static_cast<std::int8_t>(data[2]) * 24);
    file.resize((file.size() + 15) / 16 * 16);  // where the last section begins
    file.insert(file.end(), data + head_bytes, data + size);
    const std::size_t whole = file.size();
    Edit edit(std::move(file));
    edit.u32(at::file_bytes, whole)
        .u8(at_entry + at::codec, filtered ? 2 : 1)
        .u16(at_entry + at::version, !filtered      ? 1
                                     : many_sources ? 3
                                                    : 2);
    edit.u32(at_entry + at::stored_bytes, size - head_bytes)
        .u32(at_entry + at::raw_bytes, raw_bytes)
        .u64(at_entry + at::section_checksum, XXH64(data + head_bytes, size - head_bytes, 0));
    Bytes covered(edit.as_is().begin(), edit.as_is().begin() + at::checksum);
    covered.insert(covered.end(), edit.as_is().begin() + at::table,
                   edit.as_is().begin() + static_cast<std::ptrdiff_t>(table_end));
    edit.u64(at::checksum, XXH64(covered.data(), covered.size(), 0));

    drtv::Sector sector;
    const drtv::ReadStatus status = drtv::read_sector(edit.as_is(), sector);
    require(status.ok() || status.error == drtv::ReadError::bad_section ||
            status.error == drtv::ReadError::bad_table);  // the latter for raw bytes over 16 MiB
    if (!status.ok())
        return 0;
    drtv::Sector again;
    require(drtv::read_sector(drtv::write_sector(sector), again).ok());
    require(again == sector);
    return 0;
}
