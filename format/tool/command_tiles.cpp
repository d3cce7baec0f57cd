#include "commands.h"
#include "kit/exit_code.h"
#include "kit/files.h"

#include <drtv/sky_tile.h>

#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drtv::tool {

int run_tiles(const TilesRequest& request) {
    const auto files = kit::sector_files(request.path);
    if (!files)
        return kit::exit_unreadable;
    std::vector<SkyTile> tiles;
    std::map<std::pair<std::int32_t, std::int32_t>, std::string> known;
    for (const std::string& file : *files) {
        int exit_code = kit::exit_valid;
        const auto sector = kit::load_raw_sector(file, exit_code);
        if (!sector)
            return exit_code;
        const SectorView& view = sector->view;
        const auto [entry, added] = known.try_emplace({view.i, view.j}, file);
        if (!added) {
            kit::complain(entry->second + " and " + file + " hold the same sector (" +
                          std::to_string(view.i) + ", " + std::to_string(view.j) + ")");
            return kit::exit_invalid;
        }
        tiles.push_back(sky_tile_of(view));
    }
    const std::vector<std::uint8_t> bytes = write_tiles(tiles);
    if (const std::string error = kit::write_file(request.out, bytes); !error.empty()) {
        kit::complain(error);
        return kit::exit_unreadable;
    }
    std::printf("%s: %zu tile%s, %zu bytes\n",
                request.out.c_str(),
                tiles.size(),
                tiles.size() == 1 ? "" : "s",
                bytes.size());
    return kit::exit_valid;
}

}  // namespace drtv::tool
