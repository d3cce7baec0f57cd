#include "commands.h"
#include "folder/manifest.h"
#include "kit/files.h"

#include <drtv/sky_tile.h>

#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drtv::tool {

cli::Result<cli::ExitCode> run_tiles(const TilesRequest& request) {
    const auto files = kit::sector_files(request.path);
    if (!files)
        return tl::unexpected(files.error());
    folder::warn_of_pull(request.path);
    std::vector<SkyTile> tiles;
    std::map<std::pair<std::int32_t, std::int32_t>, std::string> known;
    for (const std::string& file : *files) {
        const auto sector = kit::load_raw_sector(file);
        if (!sector)
            return tl::unexpected(sector.error());
        const SectorView& view = sector->view;
        const auto [entry, added] = known.try_emplace({view.i, view.j}, file);
        if (!added) {
            return cli::fail(cli::exit_invalid,
                             entry->second + " and " + file + " hold the same sector (" +
                                 std::to_string(view.i) + ", " + std::to_string(view.j) + ")");
        }
        tiles.push_back(sky_tile_of(view));
    }
    const std::vector<std::uint8_t> bytes = write_tiles(tiles);
    if (auto written = kit::write_file(request.out, bytes); !written)
        return tl::unexpected(written.error());
    std::printf("%s: %zu tile%s, %zu bytes\n",
                request.out.c_str(),
                tiles.size(),
                tiles.size() == 1 ? "" : "s",
                bytes.size());
    return cli::exit_done;
}

}  // namespace drtv::tool
