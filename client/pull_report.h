// What a pull did, on standard output.
#pragma once

#include <cstdint>
#include <string>

namespace drtv::client {

// Numbers of sector files, but for the last.
struct PullReport {
    std::string job;  // "12"
    std::string folder;
    std::int64_t pulled = 0;
    std::int64_t unchanged = 0;   // there already
    std::int64_t removed = 0;     // the map no longer has them
    std::int64_t unfinished = 0;  // sectors
};

// A line of text or of JSON.
void print_pull(const PullReport& report, bool as_json);

}  // namespace drtv::client
