// Runs requests on a resident worker process of this machine. A worker's death costs only what was in flight:
// those requests are tried again one by one, so that the guilty one is found and fails alone.
#pragma once

#include "bakerd/farm/error.h"
#include "bakerd/farm/worker_process.h"
#include "bakerd/farm/worker_protocol.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace drtv::farm {

using Outcome = decltype(WorkerAnswer::what);

// A request is tried this often; two retries after the first failure.
inline constexpr int max_attempts = 3;

class LocalExecutor {
  public:
    struct Options {
        std::vector<std::string> worker_command;
        int threads = 1;  // sectors in flight: a few more than threads, so that none waits
        // A worker that answers nothing for so long while it has work hangs, and is ended. The dearest sector
        // that settings allow takes minutes.
        std::chrono::milliseconds stall_limit = std::chrono::minutes(30);
    };
    // Called from the executor's own thread, never under its lock.
    struct Callbacks {
        std::function<std::optional<BakeRequest>()> next;  // the next sector to bake; `id` is the caller's
        std::function<void(std::uint64_t id, int failed_attempts, Outcome outcome)> finished;
    };

    LocalExecutor(Options options, Callbacks callbacks);

    // Stops without patience.
    ~LocalExecutor();
    LocalExecutor(const LocalExecutor&) = delete;
    LocalExecutor& operator=(const LocalExecutor&) = delete;

    // There may be something new behind `next`.
    void wake();

    // Has the worker answer this before any waiting sector.
    [[nodiscard]] std::future<Outcome> ask(WorkerRequest request);

    // Takes no more work, waits at most `patience` until what is in flight has finished, then ends the
    // worker. What was not finished is not reported; open and later questions are answered with a refusal.
    void stop(std::chrono::milliseconds patience);

  private:
    struct Request {
        WorkerRequest what;
        std::uint64_t caller_id = 0;                     // of a sector
        std::shared_ptr<std::promise<Outcome>> promise;  // of a question
        int failed_attempts = 0;
        bool alone = false;  // was in flight when a worker died
    };
    struct Event {
        std::uint64_t worker = 0;                      // which of the workers started so far
        std::variant<WorkerAnswer, std::string> what;  // or how the worker died
    };

    void run();
    void handle(const Event& event);
    void handle_answer(const WorkerAnswer& answer);
    void handle_death(const std::string& how);
    void retry_or_fail(Request request, const std::string& sentence);
    void finish(Request& request, Outcome outcome);
    void fill_window();
    [[nodiscard]] std::optional<Request> next_request();
    [[nodiscard]] bool ensure_worker();
    void send(Request request);

    const Options options_;
    const Callbacks callbacks_;
    const std::size_t window_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Event> events_;       // guarded by mutex_
    std::deque<Request> questions_;  // guarded by mutex_
    bool woken_ = false;             // guarded by mutex_
    bool draining_ = false;          // guarded by mutex_
    bool stopping_ = false;          // guarded by mutex_
    bool idle_ = false;  // guarded by mutex_; the thread waits and nothing is in flight, for drain()

    // Used by the executor's thread only.
    std::unique_ptr<WorkerProcess> worker_;
    std::uint64_t worker_number_ = 0;
    std::uint64_t next_id_ = 1;
    std::chrono::steady_clock::time_point last_news_;  // last answer, or the first request after a pause
    std::map<std::uint64_t, Request> in_flight_;       // by the id sent to the worker
    std::deque<Request> again_;                        // to be tried again, alone

    std::thread thread_;
};

}  // namespace drtv::farm
