// What the local executor has its worker do next.
#include "bakerd/executor/local_executor.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

namespace drtv::executor {

std::optional<LocalExecutor::Work> LocalExecutor::next_work() {
    {
        const std::lock_guard lock(mutex_);
        if (draining_ || stopping_)
            return std::nullopt;
        if (!questions_.empty() && has_room(Rank::question)) {
            Work work = std::move(questions_.front());
            questions_.pop_front();
            return work;
        }
    }
    if (!again_.empty() && has_room(again_.front().rank)) {
        // A suspect runs when nothing else does, and nothing joins it.
        if (again_.front().alone && !in_flight_.empty())
            return std::nullopt;
        Work work = std::move(again_.front());
        again_.pop_front();
        return work;
    }
    for (const auto& [priority, rank] :
         {std::pair(Priority::interactive, Rank::interactive), std::pair(Priority::nightly, Rank::nightly)}) {
        std::optional<SectorTask> task = has_room(rank) ? callbacks_.next(priority) : std::nullopt;
        if (!task)
            continue;
        Work work;
        work.sector = task->id;
        work.what = std::move(task->request);
        work.rank = rank;
        return work;
    }
    return std::nullopt;
}

// Nothing waits here for what is begun after it.
bool LocalExecutor::has_room(Rank rank) const {
    const auto ahead =
        std::ranges::count_if(in_flight_, [rank](const auto& entry) { return entry.second.rank <= rank; });
    return static_cast<std::size_t>(ahead) < window_;
}

void LocalExecutor::fill_window() {
    for (;;) {
        if (in_flight_.size() == 1 && in_flight_.begin()->second.alone)
            return;
        std::optional<Work> work = next_work();
        if (!work)
            return;
        send(std::move(*work));
    }
}

bool LocalExecutor::ensure_worker() {
    if (worker_)
        return true;
    const std::uint64_t number = ++worker_number_;
    const auto post = [this, number](auto what) {
        {
            const std::lock_guard lock(mutex_);
            events_.push_back({number, std::move(what)});
        }
        changed_.notify_all();
    };
    auto worker = WorkerProcess::start(options_.worker_command,
                                       {[post](worker::Answer answer) { post(std::move(answer)); },
                                        [post](std::string how) { post(std::move(how)); }});
    if (!worker) {
        spdlog::error("{}", worker.error().message);
        return false;
    }
    worker_ = std::move(*worker);
    spdlog::info("worker {} started", worker_->pid());
    return true;
}

void LocalExecutor::send(Work work) {
    if (!ensure_worker()) {
        // The machine may be out of processes; the attempts bound how long we hope.
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        retry_or_fail(std::move(work), "no worker could be started");
        return;
    }
    if (in_flight_.empty())
        last_news_ = std::chrono::steady_clock::now();
    const std::uint64_t id = next_id_++;
    const auto [entry, added] = in_flight_.emplace(id, std::move(work));
    worker_->send({id, entry->second.what, static_cast<std::uint8_t>(entry->second.rank)});
}

}  // namespace drtv::executor
