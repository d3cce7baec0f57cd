// What ends calls: ctrl-C, which is noted, so that a command ends in good order, and the time of --timeout.
#pragma once

#include <chrono>
#include <string>

namespace grpc {
class ClientContext;
}

namespace drtv::client {

// From now on ctrl-C ends nothing by itself, and is noted. What waits for the terminal or for a call ends.
void catch_interrupt();

// Whether ctrl-C has been seen since. Thread-safe.
[[nodiscard]] bool interrupted();

using Deadline = std::chrono::system_clock::time_point;

// From now on calls end by then, too. Thread-safe.
void end_calls_by(Deadline deadline);
[[nodiscard]] bool time_is_over();

// Cancels a call as soon as ctrl-C is seen, and gives it the deadline of all. A call that does not let go
// even so, because the line takes no byte of what is under way, ends the program: it complains with
// `sentence` and exits with exit_interrupted. The context must outlive it.
class InterruptGuard {
  public:
    explicit InterruptGuard(grpc::ClientContext& context, std::string sentence = "interrupted");
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

  private:
    grpc::ClientContext& context_;
};

}  // namespace drtv::client
