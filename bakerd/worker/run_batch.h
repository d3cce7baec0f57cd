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
    std::string log;   // file that standard error goes to; likewise
};

// Bakes what has no answer yet, and leaves an answer for each sector; more than one copy may run at the same
// time. A sentence where this build or machine must not, or an answer could not be written.
[[nodiscard]] tl::expected<void, std::string> run_batch(const BatchOptions& options);

}  // namespace drtv::worker
