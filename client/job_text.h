// A job in words and as JSON.
#pragma once

#include "client/job_report.h"
#include "drtv/v1/job.pb.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace drtv::client {

using v1::Job;

[[nodiscard]] std::string job_number(const Job& job);    // "12"
[[nodiscard]] std::string state_name(Job::State state);  // "succeeded"
[[nodiscard]] bool has_ended(const Job& job);
[[nodiscard]] double seconds_of(const Job& job);  // from its making to its end; 0 before

[[nodiscard]] nlohmann::ordered_json causes_json(const JobReport& report);
// One object; with `report` also why its sectors were not in the cache.
[[nodiscard]] std::string json_line(const Job& job, const JobReport* report = nullptr);
[[nodiscard]] std::string one_line(const Job& job);  // "job 12 succeeded: 140 of 140 sectors ..."

// "3 of 4 nodes, 12 tasks at work, 30 in the queue, 2 lost".
[[nodiscard]] std::string cluster_text(const v1::ClusterState& cluster);

// ", 2 jobs ahead, begins in about 3 min"; empty where it does not wait.
[[nodiscard]] std::string wait_text(const Job& job);

// ", 12 of them from the cache, 3 nearly the same (at most 0.1 % off)"; empty when all are baked.
[[nodiscard]] std::string reused_text(const Job& job);

}  // namespace drtv::client
