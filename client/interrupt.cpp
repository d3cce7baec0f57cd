#include "client/interrupt.h"

#include "format/cli/report.h"

#include <fcntl.h>
#include <grpcpp/grpcpp.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace drtv::client {
namespace {

using Clock = std::chrono::system_clock;  // that of gRPC's deadlines

std::atomic<bool> interrupt_seen{false};
std::atomic<Clock::time_point> deadline_of_calls{Clock::time_point::max()};
std::array<int, 2> wake_pipe = {-1, -1};

// gRPC ends a cancelled call only after the write that is under way, and a line that stands still takes none.
constexpr std::chrono::milliseconds cancel_patience{500};

std::mutex open_calls_mutex;
struct OpenCall {
    grpc::ClientContext* context;
    std::string sentence;  // that ctrl-C during the call says
};
std::vector<OpenCall> open_calls;  // guarded by open_calls_mutex; a call within another stands behind it

// A handler may do no more than this.
void on_interrupt(int) {
    interrupt_seen = true;
    const char byte = 0;
    static_cast<void>(!::write(wake_pipe[1], &byte, 1));
}

void cancel_calls_on_interrupt() {
    char byte = 0;
    while (::read(wake_pipe[0], &byte, 1) != 0) {
        {
            const std::lock_guard lock(open_calls_mutex);
            for (const OpenCall& call : open_calls)
                call.context->TryCancel();
        }
        std::this_thread::sleep_for(cancel_patience);
        const std::lock_guard lock(open_calls_mutex);
        if (open_calls.empty())
            continue;
        // Over the progress bar.
        if (::isatty(STDERR_FILENO) == 1)
            std::fputs("\r\x1b[K", stderr);
        std::_Exit(cli::complain({cli::exit_interrupted, open_calls.front().sentence}));
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

void limit_time(double seconds) {
    if (seconds > 0)
        deadline_of_calls = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                               std::chrono::duration<double>(seconds));
}

bool time_is_over() {
    return Clock::now() >= deadline_of_calls.load();
}

InterruptGuard::InterruptGuard(grpc::ClientContext& context, std::string sentence) : context_(context) {
    if (const auto deadline = deadline_of_calls.load(); deadline != Clock::time_point::max())
        context_.set_deadline(deadline);
    const std::lock_guard lock(open_calls_mutex);
    open_calls.push_back({&context_, std::move(sentence)});
    if (interrupted())
        context_.TryCancel();
}

InterruptGuard::~InterruptGuard() {
    const std::lock_guard lock(open_calls_mutex);
    std::erase_if(open_calls, [this](const OpenCall& call) { return call.context == &context_; });
}

}  // namespace drtv::client
