// Runs requests on a resident worker process of this machine. A worker's death costs only what was in flight:
// those requests are tried again one by one, so that the guilty one is found and fails alone.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/executor/worker_process.h"

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

namespace drtv::executor {

class LocalExecutor final : public Executor {
  public:
    struct Options {
        std::vector<std::string> worker_command;
        int threads = 1;  // in flight, of each rank: a few more than threads, so that none waits
        // A worker that has work and stays silent for this long is considered hung and is killed. The most
        // expensive sector that settings allow takes minutes.
        std::chrono::milliseconds stall_limit = std::chrono::minutes(30);
    };
    LocalExecutor(Options options, Callbacks callbacks);

    // Stops without patience.
    ~LocalExecutor() override;
    LocalExecutor(const LocalExecutor&) = delete;
    LocalExecutor& operator=(const LocalExecutor&) = delete;

    void wake() override;
    [[nodiscard]] std::future<Reply<worker::MapSummary>> inspect(worker::InspectRequest question) override;
    [[nodiscard]] std::future<Reply<worker::Assessments>> assess(worker::AssessRequest question) override;
    void stop(std::chrono::milliseconds patience) override;

  private:
    using What = decltype(worker::Request::what);
    using Outcome = decltype(worker::Answer::what);
    // What is begun before what, where the worker has no thread for it yet.
    enum class Rank : std::uint8_t { question, interactive, nightly };
    struct Work {
        What what;
        Rank rank = Rank::question;
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
    [[nodiscard]] bool has_room(Rank rank) const;
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

}  // namespace drtv::executor
