#include "client/pull_report.h"

#include "client/number_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace drtv::client {
namespace {

std::string json_of(const PullReport& report) {
    nlohmann::ordered_json json;
    json["kind"] = "pull";
    json["job"] = report.job;
    json["folder"] = report.folder;
    json["pulled"] = report.pulled;
    json["unchanged"] = report.unchanged;
    json["removed"] = report.removed;
    json["unfinished"] = report.unfinished;
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string text_of(const PullReport& report) {
    std::string text =
        fmt::format("{}: {} pulled", report.folder, counted(report.pulled, "sector file", "sector files"));
    if (report.unchanged > 0)
        text += fmt::format(", {} were there already", with_thousands(report.unchanged));
    if (report.removed > 0)
        text += fmt::format(", {} removed that the map no longer has", with_thousands(report.removed));
    if (report.unfinished > 0)
        text += fmt::format(", {} not done", counted(report.unfinished, "sector is", "sectors are"));
    return text;
}

}  // namespace

void print_pull(const PullReport& report, bool as_json) {
    std::puts((as_json ? json_of(report) : text_of(report)).c_str());
}

}  // namespace drtv::client
