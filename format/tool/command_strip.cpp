#include "arguments.h"
#include "commands.h"
#include "files.h"

#include <drtv/write.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace drtv::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> optional_sections = {"static_irradiance", "local_transfer", "convergence", "interiors"};

struct Request {
    std::string in, out;
    std::vector<std::string> keep;
    WriteOptions write;
};

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= list.size();) {
        const std::size_t end = std::min(list.find(',', start), list.size());
        parts.push_back(list.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

std::optional<Request> parse(Arguments arguments) {
    const auto parsed = ParsedArguments::parse("strip", arguments, {{"--out", true}, {"--keep", true}, {"--codec", true}});
    if (!parsed) return std::nullopt;
    if (parsed->positional.size() != 1 || !parsed->has("--out")) {
        complain("usage is: drtv strip PATH --out PATH [--keep SECTION,...] [--codec raw|zstd]");
        return std::nullopt;
    }
    Request request{parsed->positional.front(), parsed->value("--out"), {}, {}};
    const std::string keep = parsed->has("--keep") ? parsed->value("--keep") : "all";
    if (keep == "all") {
        request.keep.assign(optional_sections.begin(), optional_sections.end());
    } else if (keep != "none") {
        request.keep = split(keep);
    }
    for (const std::string& name : request.keep) {
        if (std::ranges::find(optional_sections, name) != optional_sections.end()) continue;
        complain("strip: \"" + name + "\" is no optional section: there are static_irradiance, local_transfer, convergence, interiors, all and none");
        return std::nullopt;
    }
    const std::string codec = parsed->has("--codec") ? parsed->value("--codec") : "raw";
    if (codec != "raw" && codec != "zstd") {
        complain("strip: --codec takes raw or zstd, not \"" + codec + "\"");
        return std::nullopt;
    }
    request.write.codec = codec == "zstd" ? Codec::zstd : Codec::raw;
    return request;
}

void strip(Sector& sector, const std::vector<std::string>& keep) {
    const auto keeps = [&](std::string_view name) { return std::ranges::find(keep, name) != keep.end(); };
    if (!keeps("static_irradiance")) sector.static_irradiance.clear();
    if (!keeps("local_transfer")) sector.local_transfer.reset();
    if (!keeps("convergence")) sector.convergence.reset();
    if (!keeps("interiors")) sector.interiors.clear();
}

// The folder's files keep their names below `out`; a single file becomes `out`, or lies in it where it is a folder.
std::string target_of(const std::string& file, const Request& request) {
    std::error_code code;
    if (fs::is_directory(request.in, code)) return (fs::path(request.out) / fs::path(file).lexically_relative(request.in)).string();
    if (fs::is_directory(request.out, code)) return (fs::path(request.out) / fs::path(file).filename()).string();
    return request.out;
}

}  // namespace

int run_strip(Arguments arguments) {
    const auto request = parse(arguments);
    if (!request) return exit_usage;
    std::string error;
    const auto files = sector_files(request->in, error);
    if (!files) {
        complain(error);
        return exit_unreadable;
    }
    std::size_t before = 0, after = 0;
    for (const std::string& file : *files) {
        std::vector<std::uint8_t> bytes;
        int exit_code = exit_valid;
        std::optional<Sector> sector = load_sector(file, exit_code, &bytes);
        if (!sector) return exit_code;
        strip(*sector, request->keep);
        const std::vector<std::uint8_t> stripped = write_sector(*sector, request->write);
        const std::string target = target_of(file, *request);
        std::error_code ignored;
        if (const fs::path folder = fs::path(target).parent_path(); !folder.empty()) fs::create_directories(folder, ignored);
        if (!write_file(target, stripped, error)) {
            complain(error);
            return exit_unreadable;
        }
        before += bytes.size();
        after += stripped.size();
    }
    std::printf("%zu sector file%s, %zu bytes before, %zu after\n", files->size(), files->size() == 1 ? "" : "s", before, after);
    return exit_valid;
}

}  // namespace drtv::tool
