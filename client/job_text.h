// A job in words and as JSON.
#pragma once

#include "drtv/v1/job.pb.h"

#include <string>

namespace drtv::client {

using v1::Job;

[[nodiscard]] std::string job_number(const Job& job);    // "12"
[[nodiscard]] std::string state_name(Job::State state);  // "succeeded"
[[nodiscard]] bool has_ended(const Job& job);

[[nodiscard]] std::string json_line(const Job& job);  // one object
[[nodiscard]] std::string one_line(const Job& job);   // "job 12 succeeded: 140 of 140 sectors ..."

// ", 12 of them from the cache, 3 nearly the same (at most 0.1 % off)"; empty when all are baked.
[[nodiscard]] std::string reused_text(const Job& job);

}  // namespace drtv::client
