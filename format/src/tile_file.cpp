// A file of sky tiles (SPEC.md, section 9).
#include <drtv/sky_tile.h>

#include "bytes.h"
#include "checksum.h"
#include "read_failure.h"
#include "tile_layout.h"

#include <algorithm>
#include <cstdlib>

namespace drtv {
namespace {

using namespace tile_layout;

ReadStatus check_tile_header(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 4 || load_u32(bytes, magic_at) != magic)
        return fail(ReadError::not_a_sector_file, 0, "not a file of tiles: it does not start with \"DRTL\"");
    if (bytes.size() >= size_at && load_u16(bytes, major_at) != major_version)
        return fail(ReadError::unsupported_version,
                    major_at,
                    "tile file version ",
                    load_u16(bytes, major_at),
                    ".",
                    load_u16(bytes, minor_at),
                    " is not supported: this reader knows version 1");
    if (bytes.size() < file_bytes(0))
        return fail(
            ReadError::truncated, bytes.size(), "a file of tiles needs 40 bytes, it has ", bytes.size());
    const std::size_t said = load_u32(bytes, size_at);
    if (said != bytes.size())
        return fail(bytes.size() > said ? ReadError::trailing_bytes : ReadError::truncated,
                    std::min(said, bytes.size()),
                    "the header says ",
                    said,
                    " bytes, the file has ",
                    bytes.size());
    const std::size_t count = load_u32(bytes, count_at);
    if (count > bytes.size() || file_bytes(count) != bytes.size())
        return fail(
            ReadError::bad_header, count_at, "the header says ", count, " tiles, which do not fit the file");
    if (!all_zero(bytes.subspan(count_at + 4, 16)))
        return fail(ReadError::bad_header, 16, "reserved bytes of the header are not 0");
    return {};
}

ReadStatus check_tile(const SkyTile& tile, std::size_t at) {
    const auto beyond = [](std::int64_t value, std::int64_t limit) {
        return value < -limit || value > limit;
    };
    if (beyond(tile.i, max_sector_coordinate) || beyond(tile.j, max_sector_coordinate))
        return fail(ReadError::bad_section,
                    at,
                    "the tile's sector (",
                    tile.i,
                    ", ",
                    tile.j,
                    ") lies out of the world");
    if (beyond(tile.z_origin_units, max_z_origin_units))
        return fail(
            ReadError::bad_section, at + 8, "the tile's z origin ", tile.z_origin_units, " is out of range");
    if (tile.z_shift > max_z_shift)
        return fail(
            ReadError::bad_section, at + 12, "the tile's z shift ", int{tile.z_shift}, " is larger than 10");
    if (!all_zero(tile.reserved))
        return fail(ReadError::bad_section, at + 13, "reserved bytes of a tile are not 0");
    return {};
}

}  // namespace

ReadStatus open_tiles(std::span<const std::uint8_t> bytes, std::span<const SkyTile>& tiles) {
    if (ReadStatus status = check_tile_header(bytes); !status.ok())
        return status;
    const std::size_t end = bytes.size() - checksum_bytes;
    if (load_u64(bytes, end) != xxh64(bytes.first(end)))
        return fail(ReadError::checksum_mismatch, end, "the checksum does not match the bytes");
    const std::uint8_t* first = bytes.data() + header_bytes;
    if (reinterpret_cast<std::uintptr_t>(first) % alignof(SkyTile) != 0)
        return fail(ReadError::misaligned, 0, "the bytes do not start at a multiple of 4");
    const std::span<const SkyTile> found(reinterpret_cast<const SkyTile*>(first), load_u32(bytes, count_at));
    for (std::size_t n = 0; n < found.size(); ++n) {
        const std::size_t at = header_bytes + n * sizeof(SkyTile);
        if (ReadStatus status = check_tile(found[n], at); !status.ok())
            return status;
        if (n > 0 && !is_before(found[n - 1], found[n]))
            return fail(
                ReadError::bad_section, at, "tile ", n, " does not stand behind the one before it by (j, i)");
    }
    tiles = found;
    return {};
}

const SkyTile* find_tile(std::span<const SkyTile> tiles, std::int32_t i, std::int32_t j) {
    SkyTile sought;
    sought.i = i;
    sought.j = j;
    const auto found = std::lower_bound(tiles.begin(), tiles.end(), sought, is_before);
    return found != tiles.end() && found->i == i && found->j == j ? &*found : nullptr;
}

}  // namespace drtv
