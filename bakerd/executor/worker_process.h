// A worker seen from the daemon: started on demand, its answers and its death reported to a callback.
#pragma once

#include "bakerd/store/error.h"
#include "bakerd/store/file_descriptor.h"
#include "bakerd/worker/protocol.h"

#include <sys/types.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace drtv::executor {

class WorkerProcess {
  public:
    struct Events {
        std::function<void(worker::Answer)> answered;
        std::function<void(std::string)> died;  // how, as half a sentence: "was ended by signal 9 (Killed)"
    };

    // REQUIRES: the process ignores SIGPIPE, because a worker may die while it is written to.
    // Starts `command` (program and arguments). The events come from one thread; `died` comes last,
    // once.
    [[nodiscard]] static store::Result<std::unique_ptr<WorkerProcess>> start(
        const std::vector<std::string>& command, Events events);

    // Ends the worker at once and waits for it.
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    // Never waits for the worker, which may be stopped or slow to read. What cannot be written is lost: the
    // worker has died, and its death will be reported.
    void send(const worker::Request& request);

    [[nodiscard]] pid_t pid() const { return pid_; }

  private:
    WorkerProcess(pid_t pid, store::FileDescriptor input, store::FileDescriptor output, Events events);
    void read_answers();
    void write_requests();
    [[nodiscard]] bool write_all(std::string_view text) const;

    const pid_t pid_;
    const store::FileDescriptor input_;   // we write
    const store::FileDescriptor output_;  // we read
    const Events events_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::string> to_write_;  // guarded by mutex_
    bool ending_ = false;               // guarded by mutex_

    std::thread reader_;
    std::thread writer_;
};

}  // namespace drtv::executor
