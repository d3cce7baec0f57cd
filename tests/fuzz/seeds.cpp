// Writes what each fuzz target starts from, made by the same small languages as the tests: seeds FOLDER
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"
#include "tests/map/specimen.h"

#include <drtv/sky_tile.h>
#include <drtv/write.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace {

void write(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void write_gltf(const std::filesystem::path& folder) {
    using namespace drtv::test;
    for (const auto& [name, builder] :
         {std::pair("plain", specimen()), std::pair("extended", extended_specimen())}) {
        write(folder / (std::string(name) + ".glb"), builder.glb());
        write(folder / (std::string(name) + ".gltf"), bytes_of(builder.gltf()));
    }
}

void write_sectors(const std::filesystem::path& folder) {
    using namespace drtv;
    using namespace drtv::test;
    for (const auto& [name, sector] :
         {std::pair("golden_1_0", golden_sector()), std::pair("golden_1_1", golden_sector_1_1()),
          std::pair("golden_1_2", golden_sector_1_2()), std::pair("random", random_sector_1_2(3, 5)),
          std::pair("golden_1_3", golden_sector_1_3()), std::pair("random_1_3", random_sector_1_3(3, 5)),
          std::pair("empty", random_sector(4, 0))}) {
        write(folder / (std::string(name) + ".drtv"), write_sector(sector));
        write(folder / (std::string(name) + "_zstd.drtv"), write_sector(sector, {Codec::zstd}));
    }
}

void write_tiles(const std::filesystem::path& folder) {
    std::vector<drtv::SkyTile> tiles(3);
    for (std::size_t n = 0; n < tiles.size(); ++n) {
        tiles[n].i = static_cast<std::int32_t>(n);
        tiles[n].visibility.fill(static_cast<std::uint8_t>(100 * n));
    }
    write(folder / "tiles", drtv::write_tiles(tiles));
}

void write_days(const std::filesystem::path& folder) {
    const std::string keys =
        R"([{"time": "06:00", "colour": [1, 2, 3]}, {"time": "18:30", "colour": [5, 6, 7]}])";
    const std::string sky = R"("zenith": )" + keys + R"(, "horizon": )" + keys + R"(, "sun": )" + keys;
    for (const std::string& day :
         {"{" + sky + R"(, "sun_path": {"latitude": 30, "declination": -10}})",
          "{" + sky +
              R"(, "sun_path": {"north": 5, "keys": [{"time": "1:00", "azimuth": 350, "elevation": 9}]},
                                        "sun_side": [], "groups": {"neon": )" +
              keys + "}}"}) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(day.data());
        write(folder / std::to_string(day.size()), {bytes, day.size()});
    }
}

// As fuzz_zstd reads them: index of the section, plain or filtered (of version 3), 24s of raw bytes more,
// unused; then the stored bytes.
void write_frames(const std::filesystem::path& folder) {
    using namespace drtv::test;
    const Bytes packed = drtv::write_sector(golden_sector_1_3(), {drtv::Codec::zstd});
    const std::vector<Section> raw = sections_of(golden_bytes_1_3()), stored = sections_of(packed);
    for (std::size_t n = 0; n < raw.size(); ++n) {
        Bytes seed = {static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(stored[n].codec == 2 ? 3 : 0),
                      0, 0};
        const Bytes frame = stored[n].codec == 0 ? zstd_frame(raw[n].stored) : stored[n].stored;
        seed.insert(seed.end(), frame.begin(), frame.end());
        write(folder / std::to_string(n), seed);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: seeds FOLDER\n", stderr);
        return 1;
    }
    const std::filesystem::path folder(argv[1]);
    write_gltf(folder / "gltf");
    write_sectors(folder / "reader");
    write_sectors(folder / "validator");
    write_sectors(folder / "runtime");
    write_tiles(folder / "runtime");
    write_days(folder / "runtime");
    write_frames(folder / "zstd");
    return 0;
}
