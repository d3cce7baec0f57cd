#include "arguments.h"
#include "commands.h"
#include "files.h"
#include "json_writer.h"
#include "progress_bar.h"

#include <drtv/validate.h>
#include <drtv/validate_region.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <thread>

namespace drtv::tool {
namespace {

struct CheckedFile {
    std::string path;
    std::optional<std::array<std::int32_t, 2>> named;  // the sector that its name tells
    std::string unreadable;                            // a sentence; else the rest holds
    Report report;
    std::optional<RegionSector> region;  // with --neighbours, where the file can be read
};

struct Request {
    std::vector<std::string> paths;
    ValidateOptions options;
    std::vector<const Issue*> ignored;
    bool json = false, neighbours = false, warnings_as_errors = false;
};

std::optional<Request> parse(Arguments arguments) {
    const auto parsed = ParsedArguments::parse("validate",
                                               arguments,
                                               {{"--json"},
                                                {"--quick"},
                                                {"--full"},
                                                {"--neighbours"},
                                                {"--warnings-as-errors"},
                                                {"--ignore", true},
                                                {"--max-findings", true}});
    if (!parsed)
        return std::nullopt;
    Request request;
    request.paths = parsed->positional;
    request.json = parsed->has("--json");
    request.neighbours = parsed->has("--neighbours");
    request.warnings_as_errors = parsed->has("--warnings-as-errors");
    request.options.quick = parsed->has("--quick");
    if (request.options.quick && (parsed->has("--full") || request.neighbours)) {
        complain(
            std::string("validate: --quick looks at structure and checksums only, it does not go with ") +
            (request.neighbours ? "--neighbours" : "--full"));
        return std::nullopt;
    }
    const auto most = parsed->count("--max-findings", 1, 1'000'000, request.options.max_findings);
    if (!most)
        return std::nullopt;
    request.options.max_findings = *most;
    for (const std::string& list : parsed->all("--ignore")) {
        for (const std::string& code : split_list(list)) {
            const Issue* issue = issue_of_code(code);
            if (issue == nullptr) {
                complain("validate: there is no issue \"" + code + "\"; drtv issues lists them");
                return std::nullopt;
            }
            if (issue->group == IssueGroup::structure && issue->severity == Severity::error) {
                complain("validate: " + code + " cannot be ignored: nobody can read such a file");
                return std::nullopt;
            }
            request.ignored.push_back(issue);
        }
    }
    if (request.paths.empty()) {
        complain("validate needs at least one file or folder");
        return std::nullopt;
    }
    return request;
}

// The sector that a name of the form sector_<i>_<j>.drtv tells.
std::optional<std::array<std::int32_t, 2>> sector_in_name(const std::string& path) {
    const std::string name = std::filesystem::path(path).stem().string();
    constexpr std::string_view prefix = "sector_";
    if (!name.starts_with(prefix))
        return std::nullopt;
    std::array<std::int32_t, 2> sector{};
    const char *at = name.data() + prefix.size(), *end = name.data() + name.size();
    for (std::size_t k = 0; k < 2; ++k) {
        const auto result = std::from_chars(at, end, sector[k]);
        if (result.ec != std::errc())
            return std::nullopt;
        at = result.ptr;
        if (k == 0 && (at == end || *at++ != '_'))
            return std::nullopt;
    }
    return at == end ? std::optional(sector) : std::nullopt;
}

void check_file(const Request& request, CheckedFile& file) {
    const auto bytes = read_file(file.path, file.unreadable);
    if (!bytes)
        return;
    file.report = validate_sector(*bytes, request.options);
    if (!request.neighbours)
        return;
    RegionSector region;
    region.named = file.named;
    if (read_region_sector(*bytes, region).ok())
        file.region = std::move(region);
}

// Each file by itself, on all cores.
void check_files(const Request& request, std::vector<CheckedFile>& files) {
    std::atomic<std::size_t> next = 0, done = 0;
    ProgressBar bar("checked", files.size());
    const auto work = [&] {
        for (std::size_t n; (n = next++) < files.size();) {
            check_file(request, files[n]);
            bar.show(++done);
        }
    };
    std::vector<std::jthread> helpers;
    const std::size_t threads =
        std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), files.size());
    for (std::size_t n = 1; n < threads; ++n)
        helpers.emplace_back(work);
    work();
}

// The files of one folder against each other. What cannot be read is told as such, and counts as there by its
// name. REQUIRES: all were checked.
void check_region(const Request& request, std::span<CheckedFile* const> files) {
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
        if (admit(report, *found.finding.issue, request.options))
            report.findings.push_back(std::move(found.finding));
    }
}

// Gives the number of folders.
std::size_t check_regions(const Request& request, std::vector<CheckedFile>& files) {
    std::map<std::filesystem::path, std::vector<CheckedFile*>> by_folder;
    for (CheckedFile& file : files) {
        std::error_code code;
        by_folder[std::filesystem::weakly_canonical(file.path, code).parent_path()].push_back(&file);
    }
    for (const auto& [folder, its_files] : by_folder)
        check_region(request, its_files);
    return by_folder.size();
}

const char* name_of(Severity severity) {
    return severity == Severity::error ? "error" : "warning";
}

void print_findings(const CheckedFile& file) {
    for (const Finding& finding : file.report.findings) {
        std::printf("%s: %s %s at byte %llu",
                    file.path.c_str(),
                    name_of(finding.issue->severity),
                    std::string(finding.issue->code).c_str(),
                    static_cast<unsigned long long>(finding.offset));
        if (!finding.path.empty())
            std::printf(", %s", finding.path.c_str());
        std::printf(": %s\n", finding.message.c_str());
    }
    if (file.report.truncated)
        std::printf("%s: %zu findings, the first %zu are shown\n",
                    file.path.c_str(),
                    file.report.errors + file.report.warnings,
                    file.report.findings.size());
}

void append_file(JsonWriter& json, const CheckedFile& file, bool valid) {
    const Report& report = file.report;
    json.begin_object().key("file").value(file.path).key("valid").value(valid);
    json.key("errors")
        .value(std::uint64_t{report.errors})
        .key("warnings")
        .value(std::uint64_t{report.warnings})
        .key("truncated")
        .value(report.truncated);
    json.key("findings").begin_array();
    for (const Finding& finding : report.findings) {
        json.begin_object()
            .key("code")
            .value(finding.issue->code)
            .key("severity")
            .value(name_of(finding.issue->severity));
        json.key("group")
            .value(name_of(finding.issue->group))
            .key("offset")
            .value(finding.offset)
            .key("path")
            .value(finding.path);
        json.key("value");
        if (finding.value)
            json.value(*finding.value);
        else
            json.null();
        json.key("message").value(finding.message).end_object();
    }
    json.end_array().end_object();
}

}  // namespace

int run_validate(Arguments arguments) {
    std::optional<Request> request = parse(arguments);
    if (!request)
        return exit_usage;
    request->options.ignored = request->ignored;

    int exit_code = exit_valid;
    std::vector<CheckedFile> files;
    std::set<std::filesystem::path> known;
    for (const std::string& path : request->paths) {
        if (const auto found = sector_files(path)) {
            for (const std::string& file : *found) {
                std::error_code code;
                if (!known.insert(std::filesystem::weakly_canonical(file, code)).second)
                    continue;  // named twice
                files.push_back({file, sector_in_name(file), {}, {}, {}});
            }
        } else {
            exit_code = exit_unreadable;
        }
    }
    check_files(*request, files);
    const std::size_t folders = request->neighbours ? check_regions(*request, files) : 0;

    std::size_t checked = 0, invalid = 0, warnings = 0;
    JsonWriter json;
    json.begin_object().key("files").begin_array();
    for (const CheckedFile& file : files) {
        if (!file.unreadable.empty()) {
            complain(file.unreadable);
            exit_code = std::max<int>(exit_code, exit_unreadable);
            continue;
        }
        const bool valid = file.report.valid() && !(request->warnings_as_errors && file.report.warnings > 0);
        ++checked;
        invalid += valid ? 0 : 1;
        warnings += file.report.warnings;
        if (!valid)
            exit_code = exit_invalid;
        if (request->json)
            append_file(json, file, valid);
        else
            print_findings(file);
    }
    json.end_array()
        .key("checked")
        .value(std::uint64_t{checked})
        .key("invalid")
        .value(std::uint64_t{invalid})
        .key("warnings")
        .value(std::uint64_t{warnings})
        .end_object();
    if (request->json)
        std::puts(json.text().c_str());
    else
        std::printf(
            "%zu sector file%s checked, %zu invalid%s\n",
            checked,
            checked == 1 ? "" : "s",
            invalid,
            warnings == 0
                ? ""
                : (", " + std::to_string(warnings) + (warnings == 1 ? " warning" : " warnings")).c_str());
    if (!request->json && folders > 1)
        std::printf("%zu folders, the borders of each by itself\n", folders);
    return exit_code;
}

}  // namespace drtv::tool
