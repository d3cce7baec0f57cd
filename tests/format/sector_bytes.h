// A small language for sector files that are wrong in one place: take a good file's bytes, change some, seal
// it again (all checksums right), and hand it to the reader. Offsets are those of format/SPEC.md, written out
// here once more so that a change in src/layout.h shows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drtv::test {

using Bytes = std::vector<std::uint8_t>;

namespace at {
inline constexpr std::size_t magic = 0, major = 4, minor = 6, file_bytes = 8, section_count = 12,
                             sector_i = 16, sector_j = 20, z_origin = 24, probe_count = 28, z_shift = 30,
                             reserved = 31, checksum = 56, table = 64;
// Within an entry of the table.
inline constexpr std::size_t kind = 0, version = 2, codec = 4, entry_reserved = 5, offset = 8,
                             stored_bytes = 12, raw_bytes = 16, entry_reserved2 = 20, section_checksum = 24,
                             entry_bytes = 32;
}  // namespace at

struct Section {
    std::uint16_t kind = 0, version = 1;
    std::uint8_t codec = 0;
    std::uint32_t raw_bytes = 0;
    Bytes stored;
};

// Entry `n` of the table, counted from 0.
[[nodiscard]] constexpr std::size_t entry(std::size_t n) {
    return at::table + n * at::entry_bytes;
}

[[nodiscard]] std::uint64_t get(const Bytes& file, std::size_t offset, std::size_t size);

// First byte of the section of this kind; the file must have it.
[[nodiscard]] std::size_t section_start(const Bytes& file, std::uint16_t kind);

// A file under change; every call returns the file, so that a case is one line.
class Edit {
  public:
    explicit Edit(Bytes file) : file_(std::move(file)) {}

    Edit& u8(std::size_t offset, std::uint64_t value) { return put(offset, value, 1); }
    Edit& u16(std::size_t offset, std::uint64_t value) { return put(offset, value, 2); }
    Edit& u32(std::size_t offset, std::uint64_t value) { return put(offset, value, 4); }
    Edit& u64(std::size_t offset, std::uint64_t value) { return put(offset, value, 8); }
    Edit& append(std::uint8_t byte);
    Edit& cut(std::size_t size);

    // Rewrites every section's checksum where the section lies inside the file, then the header's.
    [[nodiscard]] Bytes sealed() const;
    [[nodiscard]] const Bytes& as_is() const { return file_; }

  private:
    Edit& put(std::size_t offset, std::uint64_t value, std::size_t size);

    Bytes file_;
};

[[nodiscard]] std::vector<Section> sections_of(const Bytes& file);

// A file of these sections with the header of `file`, laid out and sealed by the rules.
[[nodiscard]] Bytes with_sections(const Bytes& file, const std::vector<Section>& sections);

// The same with other stored bytes in the section of this kind; its raw bytes stay as they are said to be.
[[nodiscard]] Bytes with_stored(const Bytes& file, std::uint16_t kind, std::uint8_t codec,
                                const Bytes& stored);
[[nodiscard]] Bytes with_one_more(const Bytes& file, const Section& section);
[[nodiscard]] Bytes without(const Bytes& file, std::uint16_t kind);

[[nodiscard]] Bytes stored_of(const Bytes& file, std::uint16_t kind);

// The golden file's bytes: what write_sector makes of golden_sector().
[[nodiscard]] Bytes golden_bytes();
[[nodiscard]] Bytes golden_bytes_1_1();
[[nodiscard]] Bytes golden_bytes_1_2();
[[nodiscard]] Bytes golden_bytes_1_3();

// A whole file from disk; empty when it cannot be read.
[[nodiscard]] Bytes read_test_file(const std::string& path);

[[nodiscard]] Bytes zstd_frame(const Bytes& raw);

}  // namespace drtv::test
