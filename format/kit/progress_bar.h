// A bar on stderr for long work. Nothing where stderr is no terminal, and nothing for the first moments.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace drtv::kit {

class ProgressBar {
  public:
    ProgressBar(std::string verb, std::size_t total);
    ~ProgressBar();  // clears the line

    // Thread-safe; draws at most ten times a second.
    void show(std::size_t done);

  private:
    using Clock = std::chrono::steady_clock;

    const std::string verb_;
    const std::size_t total_;
    const bool on_terminal_;
    std::mutex mutex_;  // guards the rest
    Clock::time_point next_;
    bool drawn_ = false;
};

}  // namespace drtv::kit
