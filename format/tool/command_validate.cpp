#include "check_files.h"
#include "cli/report.h"
#include "commands.h"
#include "folder/manifest.h"
#include "kit/files.h"
#include "validate_report.h"

#include <drtv/issues.h>
#include <drtv/validate.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace drtv::tool {
namespace {

namespace fs = std::filesystem;

cli::Result<const Issue*> issue_to_ignore(const std::string& code) {
    const Issue* issue = issue_of_code(code);
    if (issue == nullptr)
        return cli::fail(cli::exit_usage,
                         "validate: there is no issue \"" + code + "\"; drtv issues lists them");
    if (issue->group == IssueGroup::structure && issue->severity == Severity::error)
        return cli::fail(cli::exit_usage,
                         "validate: " + code + " cannot be ignored: nobody can read such a file");
    return issue;
}

// All files at and below the paths, each once. False where a path gives none: that is told.
bool find_files(const std::vector<std::string>& paths, std::vector<CheckedFile>& files) {
    bool complete = true;
    std::set<fs::path> known;
    for (const std::string& path : paths) {
        const auto found = kit::sector_files(path);
        if (!found) {
            cli::complain(found.error());
            complete = false;
            continue;
        }
        for (const std::string& file : *found) {
            std::error_code code;
            const bool is_new = known.insert(fs::weakly_canonical(file, code)).second;
            if (is_new)
                files.push_back(file_to_check(file));
        }
    }
    return complete;
}

// Of the files' folders. A file that is named itself stands for itself alone.
std::set<std::string> folders_of(const std::vector<CheckedFile>& files,
                                 const std::vector<std::string>& paths) {
    std::set<std::string> folders;
    for (const CheckedFile& file : files) {
        if (std::ranges::find(paths, file.path) != paths.end())
            continue;
        const std::string folder = fs::path(file.path).parent_path().string();
        folders.insert(folder.empty() ? "." : folder);
    }
    return folders;
}

CheckedFolder check_folder(const std::string& folder, folder::FileCheck check) {
    const auto manifest = folder::read_manifest(folder);
    if (!manifest)
        return {folder, FolderState::wrong, {manifest.error()}};
    if (!*manifest)
        return {folder,
                FolderState::no_manifest,
                {{cli::exit_invalid, folder + " has no manifest, sectors.json"}}};
    CheckedFolder checked{folder, FolderState::whole, {}};
    if ((*manifest)->pulling) {
        checked.state = FolderState::pulling;
        checked.problems.push_back(
            {cli::exit_invalid,
             folder::manifest_path(folder) + ": a pull has begun, and not come to its end: pull again"});
        return checked;
    }
    for (const std::string& sentence : folder::check_listed_files(folder, **manifest, check))
        checked.problems.push_back({cli::exit_invalid, sentence});
    if (!checked.problems.empty()) {
        checked.state = FolderState::wrong;
    } else if ((*manifest)->unfinished > 0) {
        checked.state = FolderState::unfinished;
        checked.problems.push_back({cli::exit_invalid,
                                    folder::manifest_path(folder) +
                                        ": the job was not finished when it was pulled: " +
                                        std::to_string((*manifest)->unfinished) + " sectors had no file"});
    }
    return checked;
}

// Tells what is wrong, and gives the worst of it.
cli::ExitCode tell_folder(const CheckedFolder& checked, const ValidateRequest& request) {
    constexpr std::size_t most_told = 10;
    const bool is_doubtful =
        checked.state == FolderState::no_manifest || checked.state == FolderState::unfinished;
    const bool must_be_whole =
        request.whole || (request.warnings_as_errors && checked.state == FolderState::unfinished);
    if (checked.state == FolderState::no_manifest && !must_be_whole)
        return cli::exit_done;
    cli::ExitCode exit_code = cli::exit_done;
    for (std::size_t n = 0; n < std::min(checked.problems.size(), most_told); ++n) {
        if (is_doubtful && !must_be_whole)
            cli::warn(checked.problems[n].sentence);
        else
            exit_code = std::max(exit_code, cli::complain(checked.problems[n]));
    }
    if (checked.problems.size() > most_told)
        cli::complain({cli::exit_invalid,
                       folder::manifest_path(checked.folder) + ": and " +
                           std::to_string(checked.problems.size() - most_told) + " more files"});
    return exit_code;
}

}  // namespace

cli::Result<cli::ExitCode> run_validate(const ValidateRequest& request) {
    std::vector<const Issue*> ignored;
    for (const std::string& code : request.ignored) {
        const auto issue = issue_to_ignore(code);
        if (!issue)
            return tl::unexpected(issue.error());
        ignored.push_back(*issue);
    }
    const ValidateOptions options{request.quick, request.max_findings, ignored};

    std::vector<CheckedFile> files;
    cli::ExitCode exit_code = find_files(request.paths, files) ? cli::exit_done : cli::exit_unreadable;
    check_files(files, options, request.neighbours);
    const std::size_t regions = request.neighbours ? check_regions(files, options) : 0;

    ValidateReport report(request.json);
    for (const CheckedFile& file : files) {
        if (file.unreadable) {
            exit_code = std::max(exit_code, cli::complain(*file.unreadable));
            continue;
        }
        const bool alarming = request.warnings_as_errors && file.report.warnings > 0;
        const bool valid = file.report.valid() && !alarming;
        if (!valid)
            exit_code = cli::exit_invalid;
        report.add(file, valid);
    }
    std::vector<CheckedFolder> folders;
    const auto check = request.quick ? folder::FileCheck::size : folder::FileCheck::bytes;
    for (const std::string& folder : folders_of(files, request.paths))
        folders.push_back(check_folder(folder, check));
    for (const CheckedFolder& folder : folders)
        exit_code = std::max(exit_code, tell_folder(folder, request));
    report.finish(regions, folders);
    return exit_code;
}

}  // namespace drtv::tool
