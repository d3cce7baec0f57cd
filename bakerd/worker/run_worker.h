// The worker as a process of the daemon: it answers requests until its input ends. A crash costs the requests
// in flight and nothing else.
#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

namespace drtv::worker {

struct Options {
    std::string blob_folder;
    int threads = 0;                // 0: as many as the machine has
    std::int64_t memory_bytes = 0;  // that it may take for itself; 0: no limit
    int nice = 0;                   // 0 to 19: how far other programs go before
};

// Ends the process when its input ends; gives a sentence where it cannot begin, or is sent what it does not
// understand. Standard output is the protocol's alone: whatever libraries print goes to
// standard error.
[[nodiscard]] tl::expected<void, std::string> run_worker(const Options& options);

}  // namespace drtv::worker
