// Where sectors are baked.
#pragma once

#include "bakerd/executor/reply.h"
#include "bakerd/worker/requests.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>

namespace drtv::executor {

// Interactive sectors go before nightly ones. Persisted: a number never changes its meaning.
enum class Priority : std::uint8_t { nightly = 0, interactive = 1 };

// A sector to bake; `id` is the caller's.
struct SectorTask {
    std::uint64_t id = 0;
    worker::BakeRequest request;
    Priority priority = Priority::interactive;
    double seconds = 0;  // of one thread, that baking it will take, as far as is known; 0: not
};

// What has come of it.
struct SectorEnd {
    std::uint64_t id = 0;
    int failed_attempts = 0;
    Reply<worker::SectorResult> reply;
    // Of the task on a cluster that baked it, or failed last; empty on this machine.
    std::string node{};
    std::string log{};  // file with what it printed, within the store
};

// What a cluster does for this executor.
struct ClusterState {
    std::size_t nodes = 0;
    std::size_t nodes_up = 0;  // of these, that may bake
    std::size_t tasks_waiting = 0;
    std::size_t tasks_running = 0;
    std::size_t tasks_lost = 0;  // so far: that ended before they had baked all of their sectors
    std::string trouble;         // one sentence; empty where it does what it is asked

    bool operator==(const ClusterState&) const = default;
};

// A request is tried this often; two retries after the first failure.
inline constexpr int max_attempts = 3;

class Executor {
  public:
    // Called from a thread of the executor's own, never under its lock.
    struct Callbacks {
        // Of this priority.
        std::function<std::optional<SectorTask>(Priority lowest)> next;
        std::function<void(SectorEnd end)> finished;
        // True where nobody wants the sector any more: it is not heard of again.
        std::function<bool(std::uint64_t id)> give_up;
        // True where nothing is left to do with what came of the sector.
        std::function<bool(std::uint64_t id)> is_recorded;
    };

    virtual ~Executor() = default;

    // There may be a sector to bake behind `next`, which the executor asks whenever it has room; or fewer are
    // wanted than before.
    virtual void wake() = 0;

    // Nothing where sectors are baked on this machine.
    [[nodiscard]] virtual std::optional<ClusterState> cluster() const { return std::nullopt; }

    // Answered before any waiting sector, on this machine.
    [[nodiscard]] virtual std::future<Reply<worker::MapSummary>> inspect(worker::InspectRequest question) = 0;
    [[nodiscard]] virtual std::future<Reply<worker::Assessments>> assess(worker::AssessRequest question) = 0;

    // Takes no more work, and waits at most `patience` until what is at work on this machine has finished.
    // What was not finished is not reported; open and later questions are answered with a refusal.
    virtual void stop(std::chrono::milliseconds patience) = 0;
};

}  // namespace drtv::executor
