// The threads of a process that bakes.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace drtv::worker {

class BakeThreads {
  public:
    // 0: as many as the machine has.
    explicit BakeThreads(int threads)
        : count_(threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency())),
          // One more than the arena's: the caller, which only hands out work.
          limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count_) + 1),
          arena_(count_, 0) {}

    // Of what waits for a thread, lower ranks are begun first, and within a rank what came first.
    void enqueue(std::function<void()> work, int rank = 0) {
        {
            const std::lock_guard lock(mutex_);
            waiting_.emplace(rank, std::move(work));
        }
        arena_.enqueue(in_flight_.defer([this] { next()(); }));
    }

    // Until all that was handed out is done; the caller helps.
    void wait() {
        arena_.execute([this] { in_flight_.wait(); });
    }

  private:
    [[nodiscard]] std::function<void()> next() {
        const std::lock_guard lock(mutex_);
        return std::move(waiting_.extract(waiting_.begin()).mapped());
    }

    const int count_;
    tbb::global_control limit_;
    tbb::task_arena arena_;
    tbb::task_group in_flight_;
    std::mutex mutex_;
    std::multimap<int, std::function<void()>> waiting_;  // guarded by mutex_; by rank
};

}  // namespace drtv::worker
