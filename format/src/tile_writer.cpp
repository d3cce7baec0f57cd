#include <drtv/sky_tile.h>

#include "bytes.h"
#include "checksum.h"
#include "tile_layout.h"

#include <algorithm>

namespace drtv {

using namespace tile_layout;

std::vector<std::uint8_t> write_tiles(std::span<const SkyTile> tiles) {
    std::vector<SkyTile> sorted(tiles.begin(), tiles.end());
    std::sort(sorted.begin(), sorted.end(), is_before);
    std::vector<std::uint8_t> bytes;
    append_u32(bytes, magic);
    append_u16(bytes, major_version);
    append_u16(bytes, 0);
    append_u32(bytes, file_bytes(sorted.size()));
    append_u32(bytes, sorted.size());
    append_zeros(bytes, header_bytes - bytes.size());
    const auto* first = reinterpret_cast<const std::uint8_t*>(sorted.data());
    append_bytes(bytes, {first, sorted.size() * sizeof(SkyTile)});
    append_le(bytes, xxh64(bytes));
    return bytes;
}

}  // namespace drtv
