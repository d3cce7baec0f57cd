// Runs requests on a resident worker process of this machine. A worker's death costs only what was in flight:
// those requests are tried again one by one, so that the guilty one is found and fails alone.
#pragma once

#include "bakerd/farm/reply.h"
#include "bakerd/farm/worker_process.h"
#include "bakerd/worker/requests.h"

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
#include <variant>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::farm {

// A sector to bake; `id` is the caller's.
struct SectorTask {
    std::uint64_t id = 0;
    worker::BakeRequest request;
};

// A request is tried this often; two retries after the first failure.
inline constexpr int max_attempts = 3;

class LocalExecutor {
  public:
    struct Options {
        std::vector<std::string> worker_command;
        int threads = 1;  // sectors in flight: a few more than threads, so that none waits
        // A worker that has work and stays silent for this long is considered hung and is killed. The most
        // expensive sector that settings allow takes minutes.
        std::chrono::milliseconds stall_limit = std::chrono::minutes(30);
    };
    // Called from the executor's own thread, never under its lock.
    struct Callbacks {
        std::function<std::optional<SectorTask>()> next;
        std::function<void(std::uint64_t id, int failed_attempts, Reply<worker::SectorResult> reply)>
            finished;
    };

    LocalExecutor(Options options, Callbacks callbacks);

    // Stops without patience.
    ~LocalExecutor();
    LocalExecutor(const LocalExecutor&) = delete;
    LocalExecutor& operator=(const LocalExecutor&) = delete;

    // There may be a sector to bake behind `next`, which the executor asks whenever it has room.
    void wake();

    // The worker answers these before any waiting sector.
    [[nodiscard]] std::future<Reply<worker::MapSummary>> inspect(worker::InspectRequest question);
    [[nodiscard]] std::future<Reply<worker::Assessments>> assess(worker::AssessRequest question);

    // Takes no more work, waits at most `patience` until what is in flight has finished, then ends the
    // worker. What was not finished is not reported; open and later questions are answered with a refusal.
    void stop(std::chrono::milliseconds patience);

  private:
    using What = decltype(worker::Request::what);
    using Outcome = decltype(worker::Answer::what);
    struct Work {
        What what;
        std::optional<std::uint64_t> sector;  // the caller's id; none of a question
        std::function<void(Outcome)> answer;  // of a question
        int failed_attempts = 0;
        bool alone = false;  // was in flight when a worker died
    };
    struct Event {
        std::uint64_t worker = 0;                        // which of the workers started so far
        std::variant<worker::Answer, std::string> what;  // or how the worker died
    };

    template <class Answer>
    [[nodiscard]] std::future<Reply<Answer>> ask(What question);
    void run();
    void handle(const Event& event);
    void handle_answer(const worker::Answer& answer);
    void handle_death(const std::string& how);
    void retry_or_fail(Work work, const std::string& sentence);
    void finish(Work& work, Outcome outcome);
    void fill_window();
    [[nodiscard]] std::optional<Work> next_work();
    [[nodiscard]] bool ensure_worker();
    void send(Work work);

    const Options options_;
    const Callbacks callbacks_;
    const std::size_t window_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Event> events_;    // guarded by mutex_
    std::deque<Work> questions_;  // guarded by mutex_
    bool woken_ = false;          // guarded by mutex_
    bool draining_ = false;       // guarded by mutex_
    bool stopping_ = false;       // guarded by mutex_
    bool idle_ = false;           // guarded by mutex_; the thread waits and nothing is in flight

    // Used by the executor's thread only.
    std::unique_ptr<WorkerProcess> worker_;
    std::uint64_t worker_number_ = 0;
    std::uint64_t next_id_ = 1;
    std::chrono::steady_clock::time_point last_news_;  // last answer, or the first request after a pause
    std::map<std::uint64_t, Work> in_flight_;          // by the id sent to the worker
    std::deque<Work> again_;                           // to be tried again

    std::thread thread_;
};

}  // namespace drtv::farm
