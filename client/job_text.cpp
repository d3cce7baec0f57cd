#include "client/job_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace drtv::client {

std::string job_number(const v1::Job& job) {
    return job.name().substr(job.name().find('/') + 1);
}

std::string state_name(v1::Job::State state) {
    switch (state) {
        case v1::Job::RUNNING:
            return "running";
        case v1::Job::SUCCEEDED:
            return "succeeded";
        case v1::Job::FAILED:
            return "failed";
        case v1::Job::CANCELLED:
            return "cancelled";
        default:
            return "unknown";
    }
}

bool has_ended(const v1::Job& job) {
    return job.state() == v1::Job::SUCCEEDED || job.state() == v1::Job::FAILED ||
           job.state() == v1::Job::CANCELLED;
}

std::string json_line(const v1::Job& job) {
    nlohmann::ordered_json json = {{"job", job_number(job)},
                                   {"state", state_name(job.state())},
                                   {"map", job.map().substr(job.map().find('/') + 1)},
                                   {"preset", job.settings().preset()},
                                   {"sectors_total", job.sectors_total()},
                                   {"sectors_done", job.sectors_done()},
                                   {"sectors_failed", job.sectors_failed()},
                                   {"sectors_cached", job.sectors_cached()},
                                   {"sectors_near", job.sectors_near()},
                                   {"largest_bound", job.largest_bound()},
                                   {"probes", job.probes()},
                                   {"rays", job.rays()},
                                   {"rays_per_second", job.rays_per_second()},
                                   {"seconds_left", job.seconds_left()},
                                   {"created", job.create_time_seconds()},
                                   {"ended", job.end_time_seconds()}};
    for (const auto& [key, value] : job.settings().overrides())
        json["set"][key] = value;
    if (job.has_region())
        json["region"] = {job.region().x0(), job.region().y0(), job.region().x1(), job.region().y1()};
    if (!job.error().empty())
        json["error"] = job.error();
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string with_thousands(std::int64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3)
        text.insert(at - 3, ",");
    return text;
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<std::int64_t>(seconds + 0.5);
    if (whole >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string reused_text(const v1::Job& job) {
    std::string text;
    if (job.sectors_cached() > 0)
        text += fmt::format(", {} of them from the cache", with_thousands(job.sectors_cached()));
    if (job.sectors_near() > 0)
        text += fmt::format(", {} nearly the same", with_thousands(job.sectors_near()));
    if (job.largest_bound() > 0)
        text += fmt::format(", all within {:.2g} % of an exact bake", job.largest_bound() * 100);
    return text;
}

std::string one_line(const v1::Job& job) {
    std::string text = fmt::format("job {} {}: {} of {} sectors done",
                                   job_number(job),
                                   state_name(job.state()),
                                   with_thousands(job.sectors_done()),
                                   with_thousands(job.sectors_total()));
    text += reused_text(job);
    if (job.sectors_failed() > 0)
        text += fmt::format(", {} failed", with_thousands(job.sectors_failed()));
    text += fmt::format(", {} probes", with_thousands(job.probes()));
    if (job.end_time_seconds() > 0)
        text += fmt::format(
            ", {}", duration_text(static_cast<double>(job.end_time_seconds() - job.create_time_seconds())));
    return text;
}

}  // namespace drtv::client
