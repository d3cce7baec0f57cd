// A daemon that is away for a moment, because it restarts.
#pragma once

#include <chrono>
#include <string>
#include <utility>

namespace drtv::client {

// Says once that the connection was lost, and for how long it is tried again.
class Reconnection {
  public:
    explicit Reconnection(std::string server) : server_(std::move(server)) {}

    // To be asked after each attempt that found nobody; `heard`: something arrived before. Waits for a
    // moment; false where nothing has arrived for too long, or the time is over.
    [[nodiscard]] bool try_again(bool heard);

  private:
    using Clock = std::chrono::steady_clock;

    const std::string server_;
    Clock::time_point last_contact_ = Clock::now();
    bool told_ = false;
};

}  // namespace drtv::client
