// Ctrl-C: noted, so that a command ends in good order, and calls that wait end with it.
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

// Cancels a call as soon as ctrl-C is seen. A call that does not let go even so, because the line takes no
// byte of what is under way, ends the program: it complains with `sentence` and exits with exit_interrupted.
// The context must outlive it.
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
