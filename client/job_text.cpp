#include "client/job_text.h"

#include "client/number_text.h"
#include "format/cli/report.h"
#include "settings/message/job_settings.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace drtv::client {
namespace {

using Json = nlohmann::ordered_json;

// What stands behind the collection in a resource's name: "12" of "jobs/12".
std::string last_part(const std::string& resource) {
    return resource.substr(resource.find('/') + 1);
}

// Those that are not the preset's.
void add_settings(const Job& job, Json& json) {
    const auto settings = settings::read_settings(job);
    const auto preset = settings::preset(job.settings().preset());
    if (!settings || !preset)
        return;
    for (const settings::Setting& setting : settings::table()) {
        const double value = settings::value_of(*settings, setting);
        if (value == settings::value_of(*preset, setting))
            continue;
        // As people write it: 0.001, not the double of that float.
        json["set"][std::string(setting.name)] = Json::parse(settings::text_of(value));
    }
}

}  // namespace

nlohmann::ordered_json causes_json(const JobReport& report) {
    Json causes = Json::array();
    for (const auto& [cause, sectors] : report.causes())
        causes.push_back({{"cause", cause}, {"sectors", sectors}});
    return causes;
}

std::string job_number(const Job& job) {
    return last_part(job.name());
}

std::string state_name(Job::State state) {
    switch (state) {
        case Job::WAITING:
            return "waiting";
        case Job::HELD:
            return "held";
        case Job::RUNNING:
            return "running";
        case Job::SUCCEEDED:
            return "succeeded";
        case Job::FAILED:
            return "failed";
        case Job::CANCELLED:
            return "cancelled";
        default:
            return "unknown";
    }
}

double seconds_of(const Job& job) {
    if (!job.has_end_time())
        return 0;
    const auto nanoseconds = static_cast<double>(job.end_time().nanos() - job.create_time().nanos());
    return static_cast<double>(job.end_time().seconds() - job.create_time().seconds()) + nanoseconds * 1e-9;
}

bool has_ended(const Job& job) {
    return job.state() == Job::SUCCEEDED || job.state() == Job::FAILED || job.state() == Job::CANCELLED;
}

std::string json_line(const Job& job, const JobReport* report) {
    Json json;
    json["kind"] = "job";
    json["job"] = job_number(job);
    json["state"] = state_name(job.state());
    json["map"] = last_part(job.map());
    json["preset"] = job.settings().preset();
    json["sectors_total"] = job.sectors_total();
    json["sectors_done"] = job.sectors_done();
    json["sectors_failed"] = job.sectors_failed();
    json["sectors_cached"] = job.sectors_cached();
    json["sectors_near"] = job.sectors_near();
    json["sectors_baked"] = job.sectors_done() - job.sectors_cached() - job.sectors_near();
    json["largest_bound"] = job.largest_bound();
    json["probes"] = job.probes();
    json["rays"] = job.rays();
    json["rays_per_second"] = job.rays_per_second();
    json["seconds_left"] = job.seconds_left();
    json["created"] = job.create_time().seconds();
    json["ended"] = job.end_time().seconds();
    json["seconds"] = seconds_of(job);
    json["owner"] = job.owner();
    json["label"] = job.label();
    json["jobs_ahead"] = job.jobs_ahead();
    json["seconds_to_start"] = job.seconds_to_start();
    json["priority"] = job.priority() == Job::NIGHTLY ? "nightly" : "interactive";
    if (job.has_cluster()) {
        const auto& cluster = job.cluster();
        json["cluster"] = {{"nodes", cluster.nodes()},
                           {"nodes_up", cluster.nodes_up()},
                           {"tasks_waiting", cluster.tasks_waiting()},
                           {"tasks_running", cluster.tasks_running()},
                           {"tasks_lost", cluster.tasks_lost()},
                           {"trouble", cluster.trouble()}};
    }
    add_settings(job, json);
    if (job.has_region()) {
        const auto& region = job.region();
        json["region"] = {region.x0(), region.y0(), region.x1(), region.y1()};
    }
    if (!job.error().empty())
        json["error"] = job.error();
    // What this command has told, of the map too.
    if (has_ended(job))
        json["warnings"] = cli::warnings_told();
    if (report != nullptr)
        json["causes"] = causes_json(*report);
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string reused_text(const Job& job) {
    std::string text;
    if (job.sectors_cached() > 0)
        text += fmt::format(", {} of them from the cache", with_thousands(job.sectors_cached()));
    if (job.sectors_near() > 0)
        text += fmt::format(", {} nearly the same", with_thousands(job.sectors_near()));
    if (job.largest_bound() > 0)
        text += fmt::format(", all within {:.2g} % of an exact bake", job.largest_bound() * 100);
    return text;
}

std::string cluster_text(const v1::ClusterState& cluster) {
    std::string text = fmt::format("{} of {} nodes, {} at work, {} in the queue",
                                   cluster.nodes_up(),
                                   cluster.nodes(),
                                   counted(cluster.tasks_running(), "task", "tasks"),
                                   with_thousands(cluster.tasks_waiting()));
    if (cluster.tasks_lost() > 0)
        text += fmt::format(", {} lost", with_thousands(cluster.tasks_lost()));
    return text;
}

std::string wait_text(const Job& job) {
    if (job.state() != Job::WAITING || job.jobs_ahead() == 0)
        return "";
    std::string text = fmt::format(", {} ahead", counted(job.jobs_ahead(), "job", "jobs"));
    if (job.seconds_to_start() > 0)
        text += fmt::format(", begins in about {}", duration_text(job.seconds_to_start()));
    return text;
}

std::string one_line(const Job& job) {
    std::string text = fmt::format("job {}{}{} {}: {} of {} sectors done",
                                   job_number(job),
                                   job.label().empty() ? "" : " \"" + job.label() + "\"",
                                   job.priority() == Job::NIGHTLY ? " (nightly)" : "",
                                   state_name(job.state()),
                                   with_thousands(job.sectors_done()),
                                   with_thousands(job.sectors_total()));
    text += wait_text(job);
    text += reused_text(job);
    if (job.sectors_failed() > 0)
        text += fmt::format(", {} failed", with_thousands(job.sectors_failed()));
    text += ", " + counted(job.probes(), "probe", "probes");
    if (job.has_cluster())
        text += "; " + cluster_text(job.cluster());
    if (job.has_end_time())
        text += fmt::format(", {}", duration_text(seconds_of(job)));
    return text;
}

}  // namespace drtv::client
