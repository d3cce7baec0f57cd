// A job in words and as JSON.
#pragma once

#include "drtv/v1/job.pb.h"

#include <string>

namespace drtv::client {

[[nodiscard]] std::string job_number(const v1::Job& job);    // "12"
[[nodiscard]] std::string state_name(v1::Job::State state);  // "succeeded"
[[nodiscard]] bool has_ended(const v1::Job& job);
[[nodiscard]] std::string json_line(const v1::Job& job);  // one object
// ", 12 of them from the cache, 3 nearly the same (at most 0.1 % off)"; empty when all are baked.
[[nodiscard]] std::string reused_text(const v1::Job& job);

[[nodiscard]] std::string one_line(const v1::Job& job);         // "job 12 succeeded: 140 of 140 sectors ..."
[[nodiscard]] std::string with_thousands(std::int64_t number);  // "12,345"
[[nodiscard]] std::string duration_text(double seconds);        // "1:05"

}  // namespace drtv::client
