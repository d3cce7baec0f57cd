#include "client/interrupt.h"

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <csignal>

namespace drtv::client {
namespace {

std::atomic<bool> interrupt_seen{false};

void on_interrupt(int) {
    interrupt_seen = true;
}

}  // namespace

void catch_interrupt() {
    std::signal(SIGINT, on_interrupt);
}

bool interrupted() {
    return interrupt_seen;
}

InterruptGuard::InterruptGuard(grpc::ClientContext& context)
    : thread_([this, &context] {
          while (!ended_) {
              if (interrupted())
                  context.TryCancel();
              std::this_thread::sleep_for(std::chrono::milliseconds(50));
          }
      }) {}

InterruptGuard::~InterruptGuard() {
    ended_ = true;
    thread_.join();
}

}  // namespace drtv::client
