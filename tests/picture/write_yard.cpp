// write_yard FOLDER: the yard's map and its sector files, for render_test.py.
#include "tests/picture/yard.h"

#include <drtv/write.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>

namespace drtv::test {
namespace {

void write(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush())
        throw std::runtime_error("cannot write " + path.string());
}

void run(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "sectors");
    write(folder / "yard.glb", yard().glb());
    for (const Sector& sector : baked_yard().files()) {
        const std::string name =
            "sector_" + std::to_string(sector.i) + "_" + std::to_string(sector.j) + ".drtv";
        write(folder / "sectors" / name, write_sector(sector));
    }
}

}  // namespace
}  // namespace drtv::test

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: write_yard FOLDER\n", stderr);
        return 2;
    }
    drtv::test::run(argv[1]);
    return 0;
}
