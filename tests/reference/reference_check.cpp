// reference_check MAP SECTOR.drtv [options]: a baked file beside the slow reference.
//
// Exit 0: no quantity is systematically off by more than 0.2 % of its mean, as far as 3 standard errors tell;
// 1: one is; 2: a file or an option is no good.
#include "tests/reference/check_compare.h"
#include "tests/reference/check_files.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string_view>

namespace drtv::reference {
namespace {

constexpr double largest_systematic = 0.002;

constexpr const char* usage =
    "usage: reference_check MAP.glb SECTOR.drtv [--probes N] [--paths P] [--seed S] [--local PAIRS] "
    "[--threads N] [--product-error E]\n"
    "  --probes N         probes, spread over the sector's list (32)\n"
    "  --paths P          the reference's paths a probe (131072)\n"
    "  --seed S           another seed, another noise (1)\n"
    "  --local PAIRS      sources a probe for local transfer, 0 for none (4)\n"
    "  --threads N        (2)\n"
    "  --product-error E  standard error of the baked numbers, relative to the probe's mean: for the second "
    "chi^2, and for a\n"
    "                     sharper verdict on v and T where probes are few or differ much (0: not known)\n";

struct Arguments {
    std::string map, sector;
    CheckSettings settings;
    double product_error = 0;
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    std::vector<std::string> files;
    for (int n = 1; n < argc; ++n) {
        const std::string option = argv[n];
        if (!option.starts_with("--")) {
            files.push_back(option);
            continue;
        }
        if (n + 1 == argc)
            throw std::invalid_argument(option + " needs a value");
        const std::string text = argv[++n];
        std::size_t used = 0;
        double value = -1;
        try {
            value = std::stod(text, &used);
        } catch (const std::exception&) {
        }
        if (used != text.size() || !(value >= 0 && value <= 1e12))
            throw std::invalid_argument(option + " cannot be '" + text + "'");
        if (option == "--probes")
            arguments.settings.probes = static_cast<std::size_t>(value);
        else if (option == "--paths")
            arguments.settings.paths = static_cast<std::uint64_t>(value);
        else if (option == "--seed")
            arguments.settings.seed = static_cast<std::uint64_t>(value);
        else if (option == "--local")
            arguments.settings.local = static_cast<std::size_t>(value);
        else if (option == "--threads")
            arguments.settings.threads = static_cast<unsigned>(value);
        else if (option == "--product-error")
            arguments.product_error = value;
        else
            throw std::invalid_argument("no option " + option);
    }
    if (files.size() != 2 || arguments.settings.probes == 0 || arguments.settings.threads == 0)
        throw std::invalid_argument("a map and a sector are needed, and at least one probe and thread");
    arguments.map = files[0];
    arguments.sector = files[1];
    return arguments;
}

void print_worst(const Quantity& quantity, const Figures& figures) {
    const ProbeFigures& probe = quantity.probes[figures.worst_probe];
    const Compared& number = probe.numbers[figures.worst_number];
    double product = 0, reference = 0;
    for (const Compared& n : probe.numbers) {
        product += n.product / static_cast<double>(probe.numbers.size());
        reference += n.reference / static_cast<double>(probe.numbers.size());
    }
    std::printf(
        "%-5s worst: probe %zu at (%.3f, %.3f, %.3f), mean %.5g, reference %.5g; %s: %.5g, reference %.5g +- "
        "%.2g\n",
        quantity.name.c_str(), probe.number, probe.position.x, probe.position.y, probe.position.z, product,
        reference, number.name.c_str(), number.product, number.reference, number.error);
}

int run(const Arguments& arguments) {
    const Sector sector = read_sector_file(arguments.sector);
    if (sector.probes.empty())
        throw std::runtime_error(arguments.sector + ": it has no probes");
    const map::Map map = read_map(arguments.map);
    std::printf(
        "sector %d, %d: %zu probes, %u rays, %u bounces, reach %g m; %s static irradiance, %s local "
        "transfer; %zu lights in the map\n",
        sector.i, sector.j, sector.probes.size(), sector.bake.rays, sector.bake.bounces,
        static_cast<double>(sector.bake.reach_m), sector.static_irradiance.empty() ? "no" : "with",
        sector.local_transfer ? "with" : "no", map.lights.size());
    const auto quantities = compare(map, sector, arguments.settings);
    std::printf("%-5s %6s %7s %11s %9s %9s %9s %9s %9s %8s %8s\n", "", "probes", "numbers", "mean |ref|",
                "syst. %", "+- %", "median %", "rms %", "ref. %", "chi^2", "with E");
    bool good = true;
    for (const Quantity& quantity : quantities) {
        const Figures f = figures_of(quantity.probes, arguments.product_error, quantity.even_noise);
        const bool is_off = off(f, largest_systematic);
        good = good && !is_off;
        std::printf("%-5s %6zu %7zu %11.5g %9.3f %9.3f %9.3f %9.3f %9.3f %8.3f %8.3f%s\n",
                    quantity.name.c_str(), f.probes, f.numbers, f.mean, 100 * f.systematic,
                    100 * f.systematic_error, 100 * f.median, 100 * f.rms, 100 * f.reference_error,
                    f.chi_squared, f.chi_squared_both, is_off ? "  OFF" : "");
    }
    for (const Quantity& quantity : quantities)
        print_worst(quantity, figures_of(quantity.probes, arguments.product_error, quantity.even_noise));
    return good ? 0 : 1;
}

}  // namespace
}  // namespace drtv::reference

int main(int argc, char** argv) {
    try {
        return drtv::reference::run(drtv::reference::parse(argc, argv));
    } catch (const std::invalid_argument& error) {
        std::cerr << "reference_check: " << error.what() << '\n' << drtv::reference::usage;
    } catch (const std::exception& error) {
        std::cerr << "reference_check: " << error.what() << '\n';
    }
    return 2;
}
