// Where sectors are baked.
#pragma once

#include "bakerd/executor/reply.h"
#include "bakerd/worker/requests.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <optional>

namespace drtv::executor {

// A sector to bake; `id` is the caller's.
struct SectorTask {
    std::uint64_t id = 0;
    worker::BakeRequest request;
};

// A request is tried this often; two retries after the first failure.
inline constexpr int max_attempts = 3;

class Executor {
  public:
    // Called from a thread of the executor's own, never under its lock.
    struct Callbacks {
        std::function<std::optional<SectorTask>()> next;
        std::function<void(std::uint64_t id, int failed_attempts, Reply<worker::SectorResult> reply)>
            finished;
    };

    virtual ~Executor() = default;

    // There may be a sector to bake behind `next`, which the executor asks whenever it has room.
    virtual void wake() = 0;

    // Answered before any waiting sector, on this machine.
    [[nodiscard]] virtual std::future<Reply<worker::MapSummary>> inspect(worker::InspectRequest question) = 0;
    [[nodiscard]] virtual std::future<Reply<worker::Assessments>> assess(worker::AssessRequest question) = 0;

    // Takes no more work, and waits at most `patience` until what is at work on this machine has finished.
    // What was not finished is not reported; open and later questions are answered with a refusal.
    virtual void stop(std::chrono::milliseconds patience) = 0;
};

}  // namespace drtv::executor
