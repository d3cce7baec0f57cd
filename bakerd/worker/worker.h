// The worker: a process that answers requests until its input ends. It keeps the last maps imported and their
// scenes warm, so that the next edit starts at once; a crash costs the requests in flight and nothing else.
#pragma once

#include <string>

namespace drtv::worker {

struct Options {
    std::string blob_folder;
    int threads = 0;  // 0: as many as the machine has
};

// Gives the process's exit status. Standard output is the protocol's alone: whatever libraries print goes to
// standard error.
[[nodiscard]] int run_worker(const Options& options);

}  // namespace drtv::worker
