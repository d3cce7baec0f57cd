#include "client/command_report.h"

#include "client/job_end.h"
#include "client/job_report.h"
#include "client/job_text.h"
#include "client/number_text.h"
#include "client/read_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace drtv::client {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t slowest_shown = 5;
constexpr std::size_t sentences_shown = 3;  // of each thing

struct Stage {
    const char* key;
    const char* words;
    double (v1::StageSeconds::*seconds)() const;
};
constexpr std::array stages = {Stage{"scene", "scenes", &v1::StageSeconds::scene},
                               Stage{"placement", "placement", &v1::StageSeconds::placement},
                               Stage{"transfer", "transfer", &v1::StageSeconds::transfer},
                               Stage{"local_transfer", "local transfer", &v1::StageSeconds::local_transfer},
                               Stage{"files", "files", &v1::StageSeconds::files}};

struct Fate {
    const char* key;
    const char* words;
    std::int64_t (v1::Placement::*count)() const;
};
constexpr std::array fates = {
    Fate{"candidates", "proposed", &v1::Placement::candidates},
    Fate{"too_near", "left out: a probe stands within the minimal distance", &v1::Placement::too_near},
    Fate{"moved_out", "moved out of solids", &v1::Placement::moved_out},
    Fate{"dropped_in_solid", "dropped: no free place near a solid", &v1::Placement::dropped_in_solid},
    Fate{"removed_by_volume", "removed by no_probes volumes", &v1::Placement::removed_by_volume},
    Fate{"thinned", "given up: more than 255 in a sector", &v1::Placement::thinned}};

Json stages_json(const v1::StageSeconds& seconds) {
    Json json;
    for (const Stage& stage : stages)
        json[stage.key] = (seconds.*stage.seconds)();
    return json;
}

Json slowest_json(const JobReport& report) {
    Json json = Json::array();
    for (const v1::Sector& sector : report.slowest(slowest_shown)) {
        Json& added = json.emplace_back();
        added["sector"] = {sector.coordinate().i(), sector.coordinate().j()};
        added["seconds"] = total_of(sector.stages());
        added["stages"] = stages_json(sector.stages());
        added["probes"] = sector.probes();
        added["rays"] = sector.rays();
    }
    return json;
}

Json warnings_json(const JobReport& report) {
    Json json = Json::array();
    for (const auto& [thing, sentences] : report.warnings) {
        Json& added = json.emplace_back();
        added["object"] = thing;
        for (const JobReport::Warning& warning : sentences)
            added["warnings"].push_back({{"sentence", warning.sentence}, {"sectors", warning.sectors}});
    }
    return json;
}

Json failures_json(const JobReport& report) {
    Json json = Json::array();
    for (const JobReport::Failure& failure : report.failures)
        json.push_back(
            {{"sector", {failure.sector.i(), failure.sector.j()}}, {"sentence", failure.sentence}});
    return json;
}

std::string json_line(const v1::Job& job, const JobReport& report) {
    Json json;
    json["kind"] = "report";
    json["job"] = job_number(job);
    json["state"] = state_name(job.state());
    json["sectors_total"] = job.sectors_total();
    json["sectors_done"] = job.sectors_done();
    json["sectors_failed"] = job.sectors_failed();
    json["sectors_cached"] = job.sectors_cached();
    json["sectors_near"] = job.sectors_near();
    json["probes"] = job.probes();
    json["seconds"] = seconds_of(job);
    json["causes"] = causes_json(report);
    json["stages"] = stages_json(report.stages);
    json["slowest"] = slowest_json(report);
    for (const Fate& fate : fates)
        json["placement"][fate.key] = (report.placement.*fate.count)();
    const v1::ReachedError error = report.error();
    json["error"] = {{"median", error.median()},
                     {"p95", error.p95()},
                     {"max", error.max()},
                     {"budget_ended", error.budget_ended()}};
    json["map_warnings"] = report.map_warnings;
    json["warnings"] = warnings_json(report);
    json["failures"] = failures_json(report);
    json["unknown"] = report.unknown;
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_causes(const JobReport& report) {
    const char* heading = "why";
    for (const auto& [cause, sectors] : report.causes())
        std::printf(
            "%-9s %9s  %s\n", std::exchange(heading, ""), with_thousands(sectors).c_str(), cause.c_str());
}

void print_times(const JobReport& report) {
    const double total = total_of(report.stages);
    if (total <= 0)
        return;
    std::printf("time      %8.2fs  in all, with sectors that were baked side by side added up\n", total);
    for (const Stage& stage : stages) {
        const double seconds = (report.stages.*stage.seconds)();
        if (seconds > 0.0005 * total)
            std::printf("          %8.2fs  %s (%.1f %%)\n", seconds, stage.words, 100 * seconds / total);
    }
    const char* heading = "slowest";
    for (const v1::Sector& sector : report.slowest(slowest_shown)) {
        std::printf("%-9s %8.2fs  sector (%d, %d): %s probes, %.2f million rays\n",
                    std::exchange(heading, ""),
                    total_of(sector.stages()),
                    sector.coordinate().i(),
                    sector.coordinate().j(),
                    with_thousands(sector.probes()).c_str(),
                    in_millions(static_cast<double>(sector.rays())));
    }
}

void print_places(const JobReport& report) {
    const char* heading = "places";
    for (const Fate& fate : fates) {
        const std::int64_t count = (report.placement.*fate.count)();
        if (count > 0)
            std::printf(
                "%-9s %9s  %s\n", std::exchange(heading, ""), with_thousands(count).c_str(), fate.words);
    }
}

void print_error(const JobReport& report, const v1::Job& job) {
    const v1::ReachedError error = report.error();
    if (error.max() <= 0)
        return;
    std::printf("error     %8.2f%%  median; 95th percentile %.2f %%, largest %.2f %%\n",
                100 * error.median(),
                100 * error.p95(),
                100 * error.max());
    if (error.budget_ended() > 0)
        std::printf("          %9s  probes used all %s rays before the error asked for, %.2g %%\n",
                    with_thousands(error.budget_ended()).c_str(),
                    with_thousands(job.settings().rays()).c_str(),
                    100 * static_cast<double>(job.settings().error()));
}

void print_warnings(const JobReport& report) {
    if (report.warning_count() == 0)
        return;
    std::printf("warnings  %9s\n", with_thousands(report.warning_count()).c_str());
    for (const std::string& sentence : report.map_warnings)
        std::printf("    %s\n", sentence.c_str());
    for (const auto& [thing, sentences] : report.warnings) {
        std::printf("  %s\n", thing.empty() ? "of no object with a name" : thing.c_str());
        for (std::size_t n = 0; n < std::min(sentences.size(), sentences_shown); ++n) {
            const auto& [sentence, sectors] = sentences[n];
            const std::string many = sectors > 1 ? fmt::format(" ({} sectors)", with_thousands(sectors)) : "";
            std::printf("    %s%s\n", sentence.c_str(), many.c_str());
        }
        if (sentences.size() > sentences_shown)
            std::printf("    and %zu more: --json has them\n", sentences.size() - sentences_shown);
    }
}

void print_failures(const JobReport& report) {
    const char* heading = "failed";
    for (const JobReport::Failure& failure : report.failures) {
        std::printf("%-9s sector (%d, %d): %s\n",
                    std::exchange(heading, ""),
                    failure.sector.i(),
                    failure.sector.j(),
                    failure.sentence.c_str());
    }
}

void print(const v1::Job& job, const JobReport& report) {
    std::puts(one_line(job).c_str());
    print_causes(report);
    print_times(report);
    print_places(report);
    print_error(report, job);
    if (report.unknown > 0)
        std::printf("          %9s  sectors are from an older bakerd, which kept neither places nor errors\n",
                    with_thousands(report.unknown).c_str());
    print_warnings(report);
    print_failures(report);
}

}  // namespace

cli::Result<cli::ExitCode> run_report(ServerConnection& connection, const std::string& job) {
    const auto found = get_job(connection, job);
    if (!found)
        return tl::unexpected(found.error());
    const auto report = read_report(connection, *found);
    if (!report)
        return tl::unexpected(report.error());
    if (connection.options.json)
        std::puts(json_line(*found, *report).c_str());
    else
        print(*found, *report);
    return cli::exit_done;
}

}  // namespace drtv::client
