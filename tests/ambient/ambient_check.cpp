// ambient_check MAP DIR [--probes N] [--surfaces N] [--paths P] [--threads N]: the relit ambient light of a
// folder of sectors beside path tracing of the map it was baked from.
#include "tests/ambient/judge_ambient.h"
#include "tests/reference/check_files.h"
#include "tests/runtime/sets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

namespace drtv::test {
namespace {

constexpr const char* usage =
    "usage: ambient_check MAP.glb DIR [--probes N] [--surfaces N] [--paths P] [--threads N]\n"
    "  --probes N    spread over all sectors (60)\n"
    "  --surfaces N  places that probes see (60)\n"
    "  --paths P     for each place, rounded up to a square (2304)\n"
    "  --threads N   (2)\n";

struct Arguments {
    std::string map;
    std::string folder;
    JudgeSettings settings;
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    std::vector<std::string> paths;
    for (int n = 1; n < argc; ++n) {
        const std::string option = argv[n];
        if (!option.starts_with("--")) {
            paths.push_back(option);
            continue;
        }
        if (n + 1 == argc)
            throw std::invalid_argument(option + " needs a value");
        const std::string text = argv[++n];
        if (text.empty() || text.size() > 6 || text.find_first_not_of("0123456789") != text.npos)
            throw std::invalid_argument(option + " cannot be '" + text + "'");
        const unsigned long value = std::stoul(text);
        if (option == "--probes")
            arguments.settings.probes = value;
        else if (option == "--surfaces")
            arguments.settings.surfaces = value;
        else if (option == "--paths")
            arguments.settings.strata =
                static_cast<std::uint32_t>(std::max(2.0, std::ceil(std::sqrt(static_cast<double>(value)))));
        else if (option == "--threads")
            arguments.settings.threads = std::max(1u, static_cast<unsigned>(value));
        else
            throw std::invalid_argument("no option " + option);
    }
    if (paths.size() != 2)
        throw std::invalid_argument("a map and a folder are needed");
    arguments.map = paths[0];
    arguments.folder = paths[1];
    return arguments;
}

void run(Arguments arguments) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(arguments.folder)) {
        if (entry.path().extension() == ".drtv")
            files.push_back(entry.path());
    }
    if (files.empty())
        throw std::runtime_error(arguments.folder + ": it has no sector files");
    std::ranges::sort(files);
    const auto count = static_cast<std::uint32_t>(files.size());
    OwnedSet set({.sectors = count,
                  .probes = count * static_cast<std::uint32_t>(max_probes),
                  .interiors = 4096,
                  .tiles = count});
    std::vector<const LoadedSector*> sectors;
    for (const std::filesystem::path& file : files) {
        const Sector sector = reference::read_sector_file(file);
        const auto reach_m = static_cast<double>(sector.bake.reach_m);
        const bool same =
            sector.bake.bounces == arguments.settings.bounces && reach_m == arguments.settings.reach_m;
        if (!sectors.empty() && !same)
            throw std::runtime_error(file.string() +
                                     ": baked with other bounces or reach than the files before it");
        arguments.settings.bounces = sector.bake.bounces;
        arguments.settings.reach_m = reach_m;
        sectors.push_back(&set.add(sector));
    }
    const map::Map map = reference::read_map(arguments.map);
    const reference::Scene scene(map);
    std::cout << arguments.map << ": " << scene.triangle_count() << " triangles, " << files.size()
              << " sectors, " << arguments.settings.bounces << " bounces\n";
    print(judge_ambient(scene, *set, sectors, twelve_moments(), arguments.settings));
}

}  // namespace
}  // namespace drtv::test

int main(int argc, char** argv) {
    try {
        drtv::test::run(drtv::test::parse(argc, argv));
        return 0;
    } catch (const std::invalid_argument& error) {
        std::cerr << "ambient_check: " << error.what() << '\n' << drtv::test::usage;
    } catch (const std::exception& error) {
        std::cerr << "ambient_check: " << error.what() << '\n';
    }
    return 2;
}
