#include "validate_report.h"

#include <cstdio>
#include <string>

namespace drtv::tool {
namespace {

const char* name_of(Severity severity) {
    return severity == Severity::error ? "error" : "warning";
}

void print_finding(const std::string& file, const Finding& finding) {
    std::printf("%s: %s %s at byte %llu",
                file.c_str(),
                name_of(finding.issue->severity),
                std::string(finding.issue->code).c_str(),
                static_cast<unsigned long long>(finding.offset));
    if (!finding.path.empty())
        std::printf(", %s", finding.path.c_str());
    std::printf(": %s\n", finding.message.c_str());
}

void print_file(const CheckedFile& file) {
    const Report& report = file.report;
    for (const Finding& finding : report.findings)
        print_finding(file.path, finding);
    if (report.truncated)
        std::printf("%s: %zu findings, the first %zu are shown\n",
                    file.path.c_str(),
                    report.errors + report.warnings,
                    report.findings.size());
}

void append_finding(kit::JsonWriter& json, const Finding& finding) {
    json.begin_object();
    json.member("code", finding.issue->code);
    json.member("severity", name_of(finding.issue->severity));
    json.member("group", name_of(finding.issue->group));
    json.member("offset", finding.offset);
    json.member("path", finding.path);
    json.key("value");
    if (finding.value)
        json.value(*finding.value);
    else
        json.null();
    json.member("message", finding.message);
    json.end_object();
}

void append_file(kit::JsonWriter& json, const CheckedFile& file, bool valid) {
    const Report& report = file.report;
    json.begin_object();
    json.member("file", file.path);
    json.member("valid", valid);
    json.count("errors", report.errors);
    json.count("warnings", report.warnings);
    json.member("truncated", report.truncated);
    json.key("findings").begin_array();
    for (const Finding& finding : report.findings)
        append_finding(json, finding);
    json.end_array();
    json.end_object();
}

const char* name_of(FolderState state) {
    switch (state) {
        case FolderState::whole:
            return "whole";
        case FolderState::no_manifest:
            return "no manifest";
        case FolderState::pulling:
            return "pulling";
        case FolderState::unfinished:
            return "unfinished";
        case FolderState::wrong:
            break;
    }
    return "wrong";
}

void append_folder(kit::JsonWriter& json, const CheckedFolder& folder) {
    json.begin_object();
    json.member("folder", folder.folder);
    json.member("state", name_of(folder.state));
    json.key("problems").begin_array();
    for (const cli::Failure& problem : folder.problems)
        json.value(problem.sentence);
    json.end_array();
    json.end_object();
}

// "", ", 1 warning" or ", 2 warnings".
std::string warnings_text(std::size_t warnings) {
    if (warnings == 0)
        return "";
    return ", " + std::to_string(warnings) + (warnings == 1 ? " warning" : " warnings");
}

}  // namespace

ValidateReport::ValidateReport(bool as_json) : as_json_(as_json) {
    json_.begin_object().key("files").begin_array();
}

void ValidateReport::add(const CheckedFile& file, bool valid) {
    ++checked_;
    invalid_ += valid ? 0 : 1;
    warnings_ += file.report.warnings;
    if (as_json_)
        append_file(json_, file, valid);
    else
        print_file(file);
}

void ValidateReport::finish(std::size_t regions, const std::vector<CheckedFolder>& folders) {
    if (as_json_) {
        json_.end_array();
        json_.key("folders").begin_array();
        for (const CheckedFolder& folder : folders)
            append_folder(json_, folder);
        json_.end_array();
        json_.count("checked", checked_);
        json_.count("invalid", invalid_);
        json_.count("warnings", warnings_);
        json_.end_object();
        std::puts(json_.text().c_str());
        return;
    }
    std::printf("%zu sector file%s checked, %zu invalid%s\n",
                checked_,
                checked_ == 1 ? "" : "s",
                invalid_,
                warnings_text(warnings_).c_str());
    if (regions > 1)
        std::printf("%zu folders, the borders of each by itself\n", regions);
    for (const CheckedFolder& folder : folders) {
        if (folder.state != FolderState::whole && folder.state != FolderState::no_manifest)
            std::printf("%s is not whole\n", folder.folder.c_str());
    }
}

}  // namespace drtv::tool
