// What ends calls: ctrl-C, which is noted, so that a command ends in good order, and the time of --timeout.
#pragma once

#include <string>

namespace grpc {
class ClientContext;
}

namespace drtv::client {

// From now on ctrl-C ends nothing by itself, and is noted. What waits for the terminal or for a call ends.
void catch_interrupt();

// Whether ctrl-C has been seen since. Thread-safe.
[[nodiscard]] bool interrupted();

// That many seconds for all calls from now on, the wait between them included; 0: no limit. Call failures are
// those of exit_timeout then (ServerConnection::failure).
void limit_time(double seconds);
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
