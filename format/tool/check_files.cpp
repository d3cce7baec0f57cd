#include "check_files.h"

#include "kit/files.h"
#include "kit/progress_bar.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <filesystem>
#include <map>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

namespace drtv::tool {
namespace {

namespace fs = std::filesystem;

// Takes a whole number from the front of `text`.
bool take_number(std::string_view& text, std::int32_t& number) {
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    if (result.ec != std::errc())
        return false;
    text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
    return true;
}

// The sector that a name of the form sector_<i>_<j>.drtv tells.
std::optional<std::array<std::int32_t, 2>> sector_in_name(const std::string& path) {
    const std::string name = fs::path(path).stem().string();
    constexpr std::string_view prefix = "sector_";
    if (!name.starts_with(prefix))
        return std::nullopt;
    std::string_view rest = std::string_view(name).substr(prefix.size());
    std::array<std::int32_t, 2> sector{};
    if (!take_number(rest, sector[0]) || !rest.starts_with('_'))
        return std::nullopt;
    rest.remove_prefix(1);
    if (!take_number(rest, sector[1]) || !rest.empty())
        return std::nullopt;
    return sector;
}

void check_file(CheckedFile& file, const ValidateOptions& options, bool for_regions) {
    const auto bytes = kit::read_file(file.path);
    if (!bytes) {
        file.unreadable = bytes.error();
        return;
    }
    file.report = validate_sector(*bytes, options);
    if (!for_regions)
        return;
    RegionSector region;
    region.named = file.named;
    if (read_region_sector(*bytes, region).ok())
        file.region = std::move(region);
}

void check_region(std::span<CheckedFile* const> files, const ValidateOptions& options) {
    std::vector<RegionSector> sectors;
    std::vector<CheckedFile*> file_of;
    std::vector<std::array<std::int32_t, 2>> unreadable;
    for (CheckedFile* file : files) {
        if (file->region) {
            sectors.push_back(std::move(*file->region));
            file_of.push_back(file);
        } else if (file->named) {
            unreadable.push_back(*file->named);
        }
    }
    for (RegionFinding& found : validate_region(sectors, unreadable)) {
        Report& report = file_of[found.sector]->report;
        if (admit(report, *found.finding.issue, options))
            report.findings.push_back(std::move(found.finding));
    }
}

}  // namespace

CheckedFile file_to_check(const std::string& path) {
    return {path, sector_in_name(path), {}, {}, {}};
}

void check_files(std::vector<CheckedFile>& files, const ValidateOptions& options, bool for_regions) {
    std::atomic<std::size_t> next = 0;
    std::atomic<std::size_t> done = 0;
    kit::ProgressBar bar("checked", files.size());
    const auto work = [&] {
        for (std::size_t n; (n = next++) < files.size();) {
            check_file(files[n], options, for_regions);
            bar.show(++done);
        }
    };
    std::vector<std::jthread> helpers;
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t threads = std::min(cores, files.size());
    for (std::size_t n = 1; n < threads; ++n)
        helpers.emplace_back(work);
    work();
}

std::size_t check_regions(std::vector<CheckedFile>& files, const ValidateOptions& options) {
    std::map<fs::path, std::vector<CheckedFile*>> by_folder;
    for (CheckedFile& file : files) {
        std::error_code code;
        const fs::path path = fs::weakly_canonical(file.path, code);
        by_folder[path.parent_path()].push_back(&file);
    }
    for (const auto& [folder, its_files] : by_folder)
        check_region(its_files, options);
    return by_folder.size();
}

}  // namespace drtv::tool
