#include "bakerd/executor/worker_process.h"

#include "bakerd/executor/spawn.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

namespace drtv::executor {

store::Result<std::unique_ptr<WorkerProcess>> WorkerProcess::start(const std::vector<std::string>& command,
                                                                   Events events) {
    auto to_worker = make_pipe();
    if (!to_worker)
        return tl::unexpected(to_worker.error());
    auto from_worker = make_pipe();
    if (!from_worker)
        return tl::unexpected(from_worker.error());
    const auto pid = spawn(command, {to_worker->read.get(), from_worker->write.get()});
    if (!pid)
        return tl::unexpected(pid.error());
    return std::unique_ptr<WorkerProcess>(new WorkerProcess(
        *pid, std::move(to_worker->write), std::move(from_worker->read), std::move(events)));
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
