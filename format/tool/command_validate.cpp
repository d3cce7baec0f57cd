#include "check_files.h"
#include "commands.h"
#include "kit/exit_code.h"
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

bool ignore(const std::string& code, std::vector<const Issue*>& ignored) {
    const Issue* issue = issue_of_code(code);
    if (issue == nullptr) {
        kit::complain("validate: there is no issue \"" + code + "\"; drtv issues lists them");
        return false;
    }
    if (issue->group == IssueGroup::structure && issue->severity == Severity::error) {
        kit::complain("validate: " + code + " cannot be ignored: nobody can read such a file");
        return false;
    }
    ignored.push_back(issue);
    return true;
}

// All files at and below the paths, each once. False where a path gives none: that is told.
bool find_files(const std::vector<std::string>& paths, std::vector<CheckedFile>& files) {
    bool complete = true;
    std::set<fs::path> known;
    for (const std::string& path : paths) {
        const auto found = kit::sector_files(path);
        if (!found) {
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

}  // namespace

int run_validate(const ValidateRequest& request) {
    std::vector<const Issue*> ignored;
    for (const std::string& code : request.ignored) {
        if (!ignore(code, ignored))
            return kit::exit_usage;
    }
    const ValidateOptions options{request.quick, request.max_findings, ignored};

    std::vector<CheckedFile> files;
    int exit_code = find_files(request.paths, files) ? kit::exit_valid : kit::exit_unreadable;
    check_files(files, options, request.neighbours);
    const std::size_t folders = request.neighbours ? check_regions(files, options) : 0;

    ValidateReport report(request.json);
    for (const CheckedFile& file : files) {
        if (!file.unreadable.empty()) {
            kit::complain(file.unreadable);
            exit_code = std::max<int>(exit_code, kit::exit_unreadable);
            continue;
        }
        const bool alarming = request.warnings_as_errors && file.report.warnings > 0;
        const bool valid = file.report.valid() && !alarming;
        if (!valid)
            exit_code = kit::exit_invalid;
        report.add(file, valid);
    }
    report.finish(folders);
    return exit_code;
}

}  // namespace drtv::tool
