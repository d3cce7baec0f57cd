// The worker as a process of the daemon: it answers requests until its input ends. A crash costs the requests
// in flight and nothing else.
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace drtv::worker {

struct Options {
    std::string blob_folder;
    int threads = 0;  // 0: as many as the machine has
};

// Ends the process when its input ends; gives a sentence where it cannot begin, or is sent what it does not
// understand. Standard output is the protocol's alone: whatever libraries print goes to
// standard error.
[[nodiscard]] tl::expected<void, std::string> run_worker(const Options& options);

}  // namespace drtv::worker
