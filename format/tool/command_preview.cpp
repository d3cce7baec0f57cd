#include "commands.h"
#include "files.h"
#include "region_picture.h"

#include <drtv/read.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <utility>

namespace drtv::tool {
namespace {

constexpr std::array<std::pair<std::string_view, DotQuantity>, 4> quantities = {
    {{"relit", DotQuantity::relit}, {"sky", DotQuantity::sky}, {"errors", DotQuantity::errors}, {"back_hits", DotQuantity::back_hits}}};

struct PreviewArguments {
    std::string folder, out;
    PictureOptions picture;
};

bool parse(Arguments arguments, PreviewArguments& parsed) {
    for (std::size_t n = 0; n < arguments.size(); ++n) {
        const std::string& argument = arguments[n];
        const bool takes_value = argument == "--out" || argument == "--metres-per-pixel" || argument == "--quantity";
        if (takes_value && n + 1 == arguments.size()) {
            complain("preview: " + argument + " needs a value");
            return false;
        }
        if (argument == "--out") {
            parsed.out = arguments[++n];
        } else if (argument == "--metres-per-pixel") {
            const std::string& text = arguments[++n];
            double& value = parsed.picture.metres_per_pixel;
            const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
            if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !(value > 0 && value < 1000)) {
                complain("preview: --metres-per-pixel takes a number between 0 and 1000, not \"" + text + "\"");
                return false;
            }
        } else if (argument == "--quantity") {
            const std::string& text = arguments[++n];
            const auto quantity = std::find_if(quantities.begin(), quantities.end(), [&](const auto& q) { return q.first == text; });
            if (quantity == quantities.end()) {
                complain("preview: --quantity takes relit, sky, errors or back_hits, not \"" + text + "\"");
                return false;
            }
            parsed.picture.dots = quantity->second;
        } else if (argument.starts_with("-")) {
            complain("preview: unknown option \"" + argument + "\"");
            return false;
        } else if (parsed.folder.empty()) {
            parsed.folder = argument;
        } else {
            complain("preview takes one folder or file, \"" + argument + "\" is one too many");
            return false;
        }
    }
    if (parsed.folder.empty() || parsed.out.empty()) {
        complain("usage is: drtv preview DIR --out FILE.png");
        return false;
    }
    return true;
}

}  // namespace

int run_preview(Arguments arguments) {
    PreviewArguments parsed;
    if (!parse(arguments, parsed)) return exit_usage;
    std::string error;
    const auto files = sector_files(parsed.folder, error);
    if (!files) {
        complain(error);
        return exit_unreadable;
    }
    std::vector<Sector> sectors;
    std::size_t probe_count = 0;
    for (const std::string& file : *files) {
        const auto bytes = read_file(file, error);
        if (!bytes) {
            complain(error);
            return exit_unreadable;
        }
        Sector sector;
        if (const ReadStatus status = read_sector(*bytes, sector); !status.ok()) {
            complain(file + ": " + status.message);
            return exit_invalid;
        }
        probe_count += sector.probes.size();
        sectors.push_back(std::move(sector));
    }
    if (const std::size_t covered = covered_sectors(sectors); covered > max_covered_sectors) {
        complain("the sectors lie too far apart for one picture: the rectangle around them has " + std::to_string(covered) + " sectors, the limit is " + std::to_string(max_covered_sectors));
        return exit_usage;
    }
    const Image image = draw_region(sectors, parsed.picture);
    if (!write_file(parsed.out, encode_png(image), error)) {
        complain(error);
        return exit_unreadable;
    }
    std::printf("%s: %zu x %zu pixels, %zu sectors, %zu probes\n", parsed.out.c_str(), image.width, image.height, sectors.size(), probe_count);
    return exit_valid;
}

}  // namespace drtv::tool
