#include "commands.h"
#include "kit/files.h"

#include <drtv/write.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string_view>

namespace drtv::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> optional_sections = {
    "static_irradiance", "light_groups", "local_transfer", "convergence", "interiors", "quality"};
void strip(Sector& sector, const std::vector<std::string>& keep) {
    const auto keeps = [&](std::string_view name) { return std::ranges::find(keep, name) != keep.end(); };
    if (!keeps("static_irradiance"))
        sector.static_irradiance.clear();
    if (!keeps("local_transfer"))
        sector.local_transfer.reset();
    if (!keeps("convergence"))
        sector.convergence.reset();
    if (!keeps("interiors"))
        sector.interiors.clear();
    if (!keeps("light_groups"))
        sector.light_groups.clear();
    if (!keeps("quality"))
        sector.quality.reset();
}

// The folder's files keep their names below `out`; a single file becomes `out`, or lies in it where it is a
// folder or ends with a slash.
std::string target_of(const std::string& file, const StripRequest& request) {
    std::error_code code;
    if (fs::is_directory(request.in, code))
        return (fs::path(request.out) / fs::path(file).lexically_relative(request.in)).string();
    if (fs::is_directory(request.out, code) || request.out.ends_with('/'))
        return (fs::path(request.out) / fs::path(file).filename()).string();
    return request.out;
}

// Whether `out` is `in` or lies below it: what is stripped away would be gone, or be found again by the next
// run.
bool is_within(const std::string& in, const std::string& out) {
    std::error_code code;
    const fs::path inner = fs::weakly_canonical(out, code), outer = fs::weakly_canonical(in, code);
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

// Sector files below the folder `out` that are not among the files just written.
std::size_t left_behind(const std::string& out, const std::set<fs::path>& written) {
    std::size_t others = 0;
    if (const auto files = kit::sector_files(out)) {
        for (const std::string& file : *files)
            others += written.contains(fs::path(file).lexically_normal()) ? 0u : 1u;
    }
    return others;
}

}  // namespace

std::vector<std::string> optional_section_names() {
    return {optional_sections.begin(), optional_sections.end()};
}

cli::Result<cli::ExitCode> run_strip(const StripRequest& request) {
    const WriteOptions write{request.compress ? Codec::zstd : Codec::raw};
    const auto files = kit::sector_files(request.in);
    if (!files)
        return tl::unexpected(files.error());
    if (is_within(request.in, request.out)) {
        return cli::fail(
            cli::exit_usage,
            "strip: " + request.out + " is, or lies in, " + request.in + ": write to another place");
    }
    std::set<fs::path> inputs;
    std::error_code code;
    for (const std::string& file : *files)
        inputs.insert(fs::weakly_canonical(file, code));
    // All are read before the first is written, so that a broken one leaves no mixture.
    for (const std::string& file : *files) {
        const std::string target = target_of(file, request);
        if (inputs.contains(fs::weakly_canonical(target, code))) {
            return cli::fail(cli::exit_usage,
                             "strip: " + target + " is a file that is stripped: write to another place");
        }
        if (const auto sector = kit::load_sector(file); !sector)
            return tl::unexpected(sector.error());
    }
    std::size_t before = 0, after = 0;
    std::set<fs::path> written;
    for (const std::string& file : *files) {
        std::vector<std::uint8_t> bytes;
        auto sector = kit::load_sector(file, &bytes);
        if (!sector)
            return tl::unexpected(sector.error());
        strip(*sector, request.keep);
        const std::vector<std::uint8_t> stripped = write_sector(*sector, write);
        const std::string target = target_of(file, request);
        std::error_code ignored;
        if (const fs::path folder = fs::path(target).parent_path(); !folder.empty())
            fs::create_directories(folder, ignored);
        if (auto done = kit::write_file(target, stripped); !done)
            return tl::unexpected(done.error());
        written.insert(fs::path(target).lexically_normal());
        before += bytes.size();
        after += stripped.size();
    }
    std::printf("%zu sector file%s, %zu bytes before, %zu after\n",
                files->size(),
                files->size() == 1 ? "" : "s",
                before,
                after);
    std::error_code ignored;
    if (fs::is_directory(request.in, ignored)) {
        if (const std::size_t others = left_behind(request.out, written); others > 0) {
            std::printf("%s holds %zu other sector file%s, left as %s\n",
                        request.out.c_str(),
                        others,
                        others == 1 ? "" : "s",
                        others == 1 ? "it was" : "they were");
        }
    }
    return cli::exit_done;
}

}  // namespace drtv::tool
