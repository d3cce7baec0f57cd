#include "commands.h"
#include "files.h"
#include "json_writer.h"

#include <drtv/validate.h>

#include <algorithm>
#include <cstdio>

namespace drtv::tool {
namespace {

void print_finding(const std::string& file, const Finding& finding) {
    const char* severity = finding.issue->severity == Severity::error ? "error" : "warning";
    std::printf("%s: %s %s at byte %llu", file.c_str(), severity, std::string(finding.issue->code).c_str(),
                static_cast<unsigned long long>(finding.offset));
    if (!finding.path.empty()) std::printf(", %s", finding.path.c_str());
    std::printf(": %s\n", finding.message.c_str());
}

void append_finding(JsonWriter& json, const Finding& finding) {
    json.begin_object().key("code").value(finding.issue->code);
    json.key("severity").value(finding.issue->severity == Severity::error ? "error" : "warning");
    json.key("offset").value(finding.offset).key("path").value(finding.path).key("message").value(finding.message);
    json.end_object();
}

}  // namespace

int run_validate(Arguments arguments) {
    bool as_json = false;
    std::vector<std::string> paths;
    for (const std::string& argument : arguments) {
        if (argument == "--json") as_json = true;
        else if (argument.starts_with("-")) {
            complain("validate: unknown option \"" + argument + "\"");
            return exit_usage;
        } else {
            paths.push_back(argument);
        }
    }
    if (paths.empty()) {
        complain("validate needs at least one file or folder");
        return exit_usage;
    }

    int exit_code = exit_valid;
    std::size_t checked = 0, invalid = 0;
    JsonWriter json;
    json.begin_object().key("files").begin_array();
    for (const std::string& path : paths) {
        std::string error;
        const auto files = sector_files(path, error);
        if (!files) {
            complain(error);
            exit_code = std::max<int>(exit_code, exit_unreadable);
            continue;
        }
        for (const std::string& file : *files) {
            const auto bytes = read_file(file, error);
            if (!bytes) {
                complain(error);
                exit_code = std::max<int>(exit_code, exit_unreadable);
                continue;
            }
            ++checked;
            const std::vector<Finding> findings = validate_sector(*bytes);
            const bool valid = std::none_of(findings.begin(), findings.end(),
                                            [](const Finding& f) { return f.issue->severity == Severity::error; });
            if (!valid) {
                ++invalid;
                exit_code = exit_invalid;
            }
            json.begin_object().key("file").value(file).key("valid").value(valid).key("findings").begin_array();
            for (const Finding& finding : findings) {
                append_finding(json, finding);
                if (!as_json) print_finding(file, finding);
            }
            json.end_array().end_object();
        }
    }
    json.end_array().key("checked").value(std::uint64_t{checked}).key("invalid").value(std::uint64_t{invalid}).end_object();
    if (as_json) std::puts(json.text().c_str());
    else std::printf("%zu sector file%s checked, %zu invalid\n", checked, checked == 1 ? "" : "s", invalid);
    return exit_code;
}

}  // namespace drtv::tool
