#include "bakerd/worker/run_batch.h"

#include "bakerd/worker/answers.h"
#include "bakerd/worker/array_file.h"
#include "bakerd/worker/bake_threads.h"
#include "bakerd/worker/worker.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>

namespace drtv::worker {
namespace {

std::int64_t peak_memory_bytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::int64_t{usage.ru_maxrss} * 1024;
}

class BatchRun {
  public:
    BatchRun(const BatchOptions& options, Answers answers, Worker& worker)
        : options_(options),
          log_(options.logs.empty() ? "" : fmt::format("{}/{}.log", options.logs, options.task)),
          answers_(std::move(answers)),
          worker_(worker) {}

    void bake(const BakeRequest& request) {
        const Digest key = answer_key(request);
        // Another copy of the task may have been here.
        if (!answers_.find(std::span(&key, 1)).empty())
            return;
        const auto what = worker_.answer({0, request}).what;
        note_load(what);
        if (const auto* result = std::get_if<SectorResult>(&what)) {
            tell(request.sector, *result);
            write(request.sector, key, *result);
        } else if (const auto* failure = std::get_if<RequestFailure>(&what)) {
            // One that may pass is no answer: another task may have a better one.
            if (failure->may_retry)
                note(request.sector, failure->sentence);
            else
                write(request.sector, key, *failure);
        }
    }

    // Why the last of the sectors without an answer has none; else empty.
    [[nodiscard]] const std::string& failure() const { return failure_; }

  private:
    static void tell(const map::SectorCoordinate& sector, const SectorResult& result) {
        spdlog::info(
            "sector ({}, {}): {} probes in {:.1f} s", sector.i, sector.j, result.probes, result.seconds);
        for (const std::string& warning : result.warnings)
            spdlog::warn("sector ({}, {}): {}", sector.i, sector.j, warning);
    }

    void write(const map::SectorCoordinate& sector, const Digest& key, decltype(TaskAnswer::what) what) {
        const TaskAnswer answer{std::move(what), options_.node, log_, peak_memory_bytes(), load_seconds_};
        if (auto written = answers_.write(key, answer); !written)
            note(sector, written.error().message);
    }

    // The first sector waits for the map; the others' answers come later.
    void note_load(const decltype(Answer::what)& what) {
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
        const auto* result = std::get_if<SectorResult>(&what);
        const std::lock_guard lock(mutex_);
        if (!is_loaded_ && result != nullptr)
            load_seconds_ = std::max(passed.count() - result->stages.total(), 0.0);
        is_loaded_ = true;
    }

    void note(const map::SectorCoordinate& sector, const std::string& sentence) {
        spdlog::error("sector ({}, {}): {}", sector.i, sector.j, sentence);
        const std::lock_guard lock(mutex_);
        failure_ = sentence;
    }

    const BatchOptions& options_;
    const std::string log_;
    const Answers answers_;
    Worker& worker_;
    const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::mutex mutex_;
    std::string failure_;     // guarded by mutex_
    bool is_loaded_ = false;  // guarded by mutex_
    std::atomic<double> load_seconds_ = 0;
};

}  // namespace

tl::expected<void, BatchFailure> run_batch(const BatchOptions& options) {
    const auto fail = [](std::string sentence, bool differs = false) {
        return tl::unexpected(BatchFailure{std::move(sentence), differs});
    };
    auto batch = read_batch(options.array, options.task);
    if (!batch)
        return fail(batch.error());
    if (auto differs = difference(batch->build, this_build()); !differs.empty())
        return fail(std::move(differs), true);
    auto answers = Answers::open(options.store_folder);
    if (!answers)
        return fail(answers.error().message);
    const auto worker = Worker::open(options.store_folder + "/blobs");
    if (!worker)
        return fail(worker.error());
    BatchRun run(options, std::move(*answers), **worker);
    BakeThreads threads(options.threads);
    for (const BakeRequest& request : batch->sectors)
        threads.enqueue([&run, &request] { run.bake(request); });
    threads.wait();
    if (!run.failure().empty())
        return fail(run.failure());
    return {};
}

}  // namespace drtv::worker
