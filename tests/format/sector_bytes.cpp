#include "tests/format/sector_bytes.h"

#include "tests/format/sectors.h"

#include <drtv/write.h>

#define XXH_INLINE_ALL
#include <xxhash.h>
#include <zstd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace drtv::test {

std::uint64_t get(const Bytes& file, std::size_t offset, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < size; ++k)
        value |= std::uint64_t{file.at(offset + k)} << (8 * k);
    return value;
}

std::size_t section_start(const Bytes& file, std::uint16_t kind) {
    for (std::size_t n = 0; n < get(file, at::section_count, 4); ++n) {
        if (get(file, entry(n) + at::kind, 2) == kind)
            return get(file, entry(n) + at::offset, 4);
    }
    throw std::logic_error("the file has no section of kind " + std::to_string(kind));
}

Edit& Edit::put(std::size_t offset, std::uint64_t value, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k)
        file_.at(offset + k) = static_cast<std::uint8_t>(value >> (8 * k));
    return *this;
}

Edit& Edit::append(std::uint8_t byte) {
    file_.push_back(byte);
    return *this;
}

Edit& Edit::cut(std::size_t size) {
    file_.resize(size);
    return *this;
}

Bytes Edit::sealed() const {
    Edit edit(file_);
    const std::size_t count = get(file_, at::section_count, 4), end = at::table + count * at::entry_bytes;
    if (end > file_.size())
        return file_;
    for (std::size_t n = 0; n < count; ++n) {
        const std::size_t offset = get(file_, entry(n) + at::offset, 4),
                          stored = get(file_, entry(n) + at::stored_bytes, 4);
        if (offset + stored <= file_.size())
            edit.u64(entry(n) + at::section_checksum, XXH64(file_.data() + offset, stored, 0));
    }
    Bytes covered(edit.file_.begin(), edit.file_.begin() + at::checksum);
    covered.insert(covered.end(), edit.file_.begin() + at::table,
                   edit.file_.begin() + static_cast<std::ptrdiff_t>(end));
    return edit.u64(at::checksum, XXH64(covered.data(), covered.size(), 0)).as_is();
}

std::vector<Section> sections_of(const Bytes& file) {
    std::vector<Section> sections;
    for (std::size_t n = 0; n < get(file, at::section_count, 4); ++n) {
        const std::size_t e = entry(n);
        const auto first = file.begin() + static_cast<std::ptrdiff_t>(get(file, e + at::offset, 4));
        sections.push_back(
            {static_cast<std::uint16_t>(get(file, e + at::kind, 2)),
             static_cast<std::uint16_t>(get(file, e + at::version, 2)),
             static_cast<std::uint8_t>(get(file, e + at::codec, 1)),
             static_cast<std::uint32_t>(get(file, e + at::raw_bytes, 4)),
             Bytes(first, first + static_cast<std::ptrdiff_t>(get(file, e + at::stored_bytes, 4)))});
    }
    return sections;
}

Bytes with_sections(const Bytes& file, const std::vector<Section>& sections) {
    Bytes out(file.begin(), file.begin() + at::table);
    out.resize(at::table + sections.size() * at::entry_bytes);
    for (std::size_t n = 0; n < sections.size(); ++n) {
        out.resize((out.size() + 15) / 16 * 16);
        Edit edit(std::move(out));
        edit.u16(entry(n) + at::kind, sections[n].kind).u16(entry(n) + at::version, sections[n].version);
        edit.u8(entry(n) + at::codec, sections[n].codec).u32(entry(n) + at::offset, edit.as_is().size());
        edit.u32(entry(n) + at::stored_bytes, sections[n].stored.size())
            .u32(entry(n) + at::raw_bytes, sections[n].raw_bytes);
        out = edit.as_is();
        out.insert(out.end(), sections[n].stored.begin(), sections[n].stored.end());
    }
    const std::size_t size = out.size();
    return Edit(std::move(out)).u32(at::file_bytes, size).u32(at::section_count, sections.size()).sealed();
}

Bytes with_stored(const Bytes& file, std::uint16_t kind, std::uint8_t codec, const Bytes& stored) {
    std::vector<Section> sections = sections_of(file);
    for (Section& section : sections) {
        if (section.kind != kind)
            continue;
        section.codec = codec;
        section.stored = stored;
    }
    return with_sections(file, sections);
}

Bytes with_one_more(const Bytes& file, const Section& section) {
    std::vector<Section> sections = sections_of(file);
    sections.push_back(section);
    return with_sections(file, sections);
}

Bytes without(const Bytes& file, std::uint16_t kind) {
    std::vector<Section> sections = sections_of(file);
    std::erase_if(sections, [&](const Section& section) { return section.kind == kind; });
    return with_sections(file, sections);
}

Bytes stored_of(const Bytes& file, std::uint16_t kind) {
    for (const Section& section : sections_of(file)) {
        if (section.kind == kind)
            return section.stored;
    }
    return {};
}

Bytes golden_bytes() {
    return write_sector(golden_sector());
}
Bytes golden_bytes_1_1() {
    return write_sector(golden_sector_1_1());
}
Bytes golden_bytes_1_2() {
    return write_sector(golden_sector_1_2());
}

Bytes golden_bytes_1_3() {
    return write_sector(golden_sector_1_3());
}

Bytes read_test_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Bytes zstd_frame(const Bytes& raw) {
    Bytes frame(ZSTD_compressBound(raw.size()));
    frame.resize(ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), 3));
    return frame;
}

}  // namespace drtv::test
