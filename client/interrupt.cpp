#include "client/interrupt.h"

#include <fcntl.h>
#include <grpcpp/grpcpp.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <mutex>
#include <set>
#include <thread>

namespace drtv::client {
namespace {

std::atomic<bool> interrupt_seen{false};
std::array<int, 2> wake_pipe = {-1, -1};

std::mutex open_calls_mutex;
std::set<grpc::ClientContext*> open_calls;  // guarded by open_calls_mutex

// A handler may do no more than this.
void on_interrupt(int) {
    interrupt_seen = true;
    const char byte = 0;
    static_cast<void>(!::write(wake_pipe[1], &byte, 1));
}

void cancel_calls_on_interrupt() {
    char byte = 0;
    while (::read(wake_pipe[0], &byte, 1) != 0) {
        const std::lock_guard lock(open_calls_mutex);
        for (grpc::ClientContext* context : open_calls)
            context->TryCancel();
    }
}

}  // namespace

void catch_interrupt() {
    if (wake_pipe[0] >= 0 || ::pipe2(wake_pipe.data(), O_CLOEXEC) != 0)
        return;
    std::thread(cancel_calls_on_interrupt).detach();
    // Without SA_RESTART: a read from the terminal ends.
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    ::sigaction(SIGINT, &action, nullptr);
}

bool interrupted() {
    return interrupt_seen;
}

InterruptGuard::InterruptGuard(grpc::ClientContext& context) : context_(context) {
    const std::lock_guard lock(open_calls_mutex);
    open_calls.insert(&context_);
    if (interrupted())
        context_.TryCancel();
}

InterruptGuard::~InterruptGuard() {
    const std::lock_guard lock(open_calls_mutex);
    open_calls.erase(&context_);
}

}  // namespace drtv::client
