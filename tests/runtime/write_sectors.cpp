// Writes some random sectors with all sections, raw, for same_bits: write_sectors FOLDER
#include "tests/format/sectors.h"

#include <drtv/write.h>

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
    for (std::uint32_t n = 0; argc == 2 && n < 4; ++n) {
        drtv::Sector sector = drtv::test::random_sector_1_3(n + 70, 40 + 60 * n);
        sector.i = 1600 + static_cast<std::int32_t>(n % 2);
        sector.j = -1600 + static_cast<std::int32_t>(n / 2);
        sector.grid.z_origin_units = 0;
        sector.grid.cell_height_units = 1500;
        const auto bytes = drtv::write_sector(sector);
        const std::string path = std::string(argv[1]) + "/" + std::to_string(n) + ".drtv";
        std::FILE* file = std::fopen(path.c_str(), "wb");
        if (file == nullptr || std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() ||
            std::fclose(file) != 0)
            return 1;
        std::printf("%s\n", path.c_str());
    }
    return argc == 2 ? 0 : 1;
}
