// A worker seen from the daemon: started on demand, its answers and its death reported to a callback.
#pragma once

#include "bakerd/farm/error.h"
#include "bakerd/farm/worker_protocol.h"

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace drtv::farm {

class WorkerProcess {
  public:
    struct Events {
        std::function<void(WorkerAnswer)> answered;
        std::function<void(std::string)> died;  // how, as half a sentence: "was killed by signal 9 (Killed)"
    };

    // REQUIRES: the process ignores SIGPIPE, because a worker may die while it is written to.
    // Starts `command` (program and arguments). The events come from a thread of its own; `died` comes last,
    // once.
    [[nodiscard]] static Result<std::unique_ptr<WorkerProcess>> start(const std::vector<std::string>& command,
                                                                      Events events);

    // Ends the worker at once and waits for it.
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    // False when the worker's input is closed: its death will be reported.
    [[nodiscard]] bool send(const WorkerRequest& request);

    [[nodiscard]] pid_t pid() const { return pid_; }

  private:
    WorkerProcess(pid_t pid, int input, int output, Events events);
    void read_answers();

    const pid_t pid_;
    int input_;   // we write
    int output_;  // we read
    const Events events_;
    std::thread reader_;
};

}  // namespace drtv::farm
