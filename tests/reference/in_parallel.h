// Work on some threads, for the checks.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace drtv::reference {

// Calls use(n) for each n below `count`, and returns when all are done.
template <class Use>
void in_parallel(unsigned threads, std::size_t count, const Use& use) {
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> workers;
    for (unsigned t = 0; t < threads; ++t) {
        workers.emplace_back([&] {
            for (std::size_t n = next++; n < count; n = next++)
                use(n);
        });
    }
}

}  // namespace drtv::reference
