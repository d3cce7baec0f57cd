#include "commands.h"
#include "files.h"

#include <drtv/sky_tile.h>

#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drtv::tool {

int run_tiles(const TilesRequest& request) {
    const auto files = sector_files(request.path);
    if (!files)
        return exit_unreadable;
    std::vector<SkyTile> tiles;
    std::map<std::pair<std::int32_t, std::int32_t>, std::string> known;
    for (const std::string& file : *files) {
        const FileRead read = read_file(file);
        if (!read.ok()) {
            complain(read.error);
            return exit_unreadable;
        }
        std::vector<std::uint8_t> raw;
        SectorView sector;
        ReadStatus status = unpack_sector(read.bytes, raw);
        if (status.ok())
            status = open_sector(raw, sector);
        if (!status.ok()) {
            complain(file + ": " + status.message);
            return exit_invalid;
        }
        const auto [entry, added] = known.try_emplace({sector.i, sector.j}, file);
        if (!added) {
            complain(entry->second + " and " + file + " hold the same sector (" + std::to_string(sector.i) +
                     ", " + std::to_string(sector.j) + ")");
            return exit_invalid;
        }
        tiles.push_back(sky_tile_of(sector));
    }
    const std::vector<std::uint8_t> bytes = write_tiles(tiles);
    if (const std::string error = write_file(request.out, bytes); !error.empty()) {
        complain(error);
        return exit_unreadable;
    }
    std::printf("%s: %zu tile%s, %zu bytes\n",
                request.out.c_str(),
                tiles.size(),
                tiles.size() == 1 ? "" : "s",
                bytes.size());
    return exit_valid;
}

}  // namespace drtv::tool
