#include "bakerd/executor/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>

extern char** environ;

namespace drtv::executor {
namespace {

std::string describe_exit(int status) {
    if (WIFSIGNALED(status))
        return fmt::format("was ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("ended with status {}", WEXITSTATUS(status));
}

struct Pipe {
    store::FileDescriptor read;
    store::FileDescriptor write;
};

std::optional<Pipe> make_pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return std::nullopt;
    return Pipe{store::FileDescriptor(ends[0]), store::FileDescriptor(ends[1])};
}

}  // namespace

store::Result<std::unique_ptr<WorkerProcess>> WorkerProcess::start(const std::vector<std::string>& command,
                                                                   Events events) {
    std::optional<Pipe> to_worker = make_pipe();
    std::optional<Pipe> from_worker = to_worker ? make_pipe() : std::nullopt;
    if (!from_worker)
        return store::fail(store::ErrorCode::internal,
                           fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, to_worker->read.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, from_worker->write.get(), STDOUT_FILENO);
    // A group of its own: ctrl-C in the daemon's terminal is the daemon's to handle.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setpgroup(&attributes, 0);
    // The daemon blocks the signals it waits for; the worker must not.
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    std::vector<char*> arguments;
    for (const std::string& argument : command)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    pid_t pid = 0;
    const int error = ::posix_spawn(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
        return store::fail(store::ErrorCode::internal,
                           fmt::format("cannot start the worker {}: {}", command[0], std::strerror(error)));
    return std::unique_ptr<WorkerProcess>(
        new WorkerProcess(pid, std::move(to_worker->write), std::move(from_worker->read), std::move(events)));
}

WorkerProcess::WorkerProcess(pid_t pid,
                             store::FileDescriptor input,
                             store::FileDescriptor output,
                             Events events)
    : pid_(pid),
      input_(std::move(input)),
      output_(std::move(output)),
      events_(std::move(events)),
      reader_([this] { read_answers(); }),
      writer_([this] { write_requests(); }) {}

WorkerProcess::~WorkerProcess() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    ::kill(pid_, SIGKILL);  // ends a read and a write that wait for the worker
    reader_.join();
    writer_.join();
    // Reaped here and not by the reader, so that the number cannot go to another process before the kill
    // above.
    ::waitpid(pid_, nullptr, 0);
}

void WorkerProcess::send(const worker::Request& request) {
    std::string text = worker::encode(request) + "\n";
    {
        const std::lock_guard lock(mutex_);
        to_write_.push_back(std::move(text));
    }
    changed_.notify_all();
}

void WorkerProcess::write_requests() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return ending_ || !to_write_.empty(); });
        if (ending_)
            return;
        const std::string text = std::move(to_write_.front());
        to_write_.pop_front();
        lock.unlock();
        if (!write_all(text))
            return;
        lock.lock();
    }
}

bool WorkerProcess::write_all(std::string_view text) const {
    while (!text.empty()) {
        const ssize_t n = ::write(input_.get(), text.data(), text.size());
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        text.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

void WorkerProcess::read_answers() {
    std::string held;
    std::array<char, 65536> buffer;
    for (;;) {
        const ssize_t n = ::read(output_.get(), buffer.data(), buffer.size());
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            break;
        held.append(buffer.data(), static_cast<std::size_t>(n));
        for (std::size_t end; (end = held.find('\n')) != std::string::npos; held.erase(0, end + 1)) {
            // A line that is no answer is a broken worker: it will be ended, and its death reported.
            if (auto answer = worker::decode_answer(std::string_view(held).substr(0, end)))
                events_.answered(std::move(*answer));
            else
                ::kill(pid_, SIGKILL);
        }
    }
    // One that closed its output and lives on will never answer.
    ::kill(pid_, SIGKILL);
    siginfo_t info{};
    while (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
    }
    const int status = info.si_code == CLD_EXITED ? info.si_status << 8 : info.si_status;
    events_.died(describe_exit(status));
}

}  // namespace drtv::executor
