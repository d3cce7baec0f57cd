// Adds the golden files that are not there yet: write_golden FOLDER. Their dumps are then `drtv dump FILE
// --json > FILE.json`.
#include "tests/format/golden_files.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: write_golden FOLDER\n", stderr);
        return 1;
    }
    for (const drtv::test::GoldenFile& golden : drtv::test::golden_files()) {
        const std::filesystem::path path = std::filesystem::path(argv[1]) / (golden.name + ".drtv");
        if (std::filesystem::exists(path))
            continue;
        const std::vector<std::uint8_t> bytes = drtv::write_sector(golden.sector, {golden.codec});
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        std::printf("%s\n", path.c_str());
    }
    return 0;
}
