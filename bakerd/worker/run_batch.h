// The worker as a task on a cluster: it bakes one batch of an array's sectors and ends.
#pragma once

#include <cstddef>
#include <string>

#include <tl/expected.hpp>

namespace drtv::worker {

struct BatchOptions {
    std::string store_folder;
    std::string array;  // path of its file
    std::size_t task = 0;
    int threads = 0;   // 0: as many as the machine has
    std::string node;  // for people
    std::string logs;  // folder within the store for what tasks print: <number>.log; likewise
};

struct BatchFailure {
    std::string sentence;
    bool differs = false;  // this build or machine must not bake for the array: another node may
};

// Bakes what has no answer yet, and leaves an answer for each sector; more than one copy may run at the same
// time.
[[nodiscard]] tl::expected<void, BatchFailure> run_batch(const BatchOptions& options);

}  // namespace drtv::worker
