// The threads of a process that bakes.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

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

    template <class Work>
    void enqueue(Work work) {
        arena_.enqueue(in_flight_.defer(std::move(work)));
    }

    // Until all that was handed out is done; the caller helps.
    void wait() {
        arena_.execute([this] { in_flight_.wait(); });
    }

  private:
    const int count_;
    tbb::global_control limit_;
    tbb::task_arena arena_;
    tbb::task_group in_flight_;
};

}  // namespace drtv::worker
