// Ctrl-C: noted, so that a command ends in good order.
#pragma once

#include <atomic>
#include <thread>

namespace grpc {
class ClientContext;
}

namespace drtv::client {

// From now on ctrl-C ends nothing, and is noted.
void catch_interrupt();

// Whether ctrl-C has been seen since. Thread-safe.
[[nodiscard]] bool interrupted();

// Cancels a call as soon as ctrl-C is seen, because reading from a stream waits for the next message. The
// context must outlive it.
class InterruptGuard {
  public:
    explicit InterruptGuard(grpc::ClientContext& context);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

  private:
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

}  // namespace drtv::client
