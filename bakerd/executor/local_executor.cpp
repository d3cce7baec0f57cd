#include "bakerd/executor/local_executor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace drtv::executor {
namespace {

const worker::RequestFailure stopping{"the server is stopping", true};

}  // namespace

LocalExecutor::LocalExecutor(Options options, Callbacks callbacks)
    : options_(std::move(options)),
      callbacks_(std::move(callbacks)),
      window_(static_cast<std::size_t>(options_.threads) + 2),
      thread_([this] { run(); }) {}

LocalExecutor::~LocalExecutor() {
    stop(std::chrono::milliseconds(0));
}

void LocalExecutor::stop(std::chrono::milliseconds patience) {
    {
        std::unique_lock lock(mutex_);
        draining_ = true;
        changed_.wait_for(lock, patience, [this] { return idle_; });
        stopping_ = true;
    }
    changed_.notify_all();
    if (!thread_.joinable())
        return;
    thread_.join();
    worker_.reset();
    // Nobody waits for an answer that cannot come.
    const auto refuse = [](Work& work) {
        if (work.answer)
            work.answer(stopping);
    };
    for (auto& [id, work] : in_flight_)
        refuse(work);
    std::for_each(again_.begin(), again_.end(), refuse);
    const std::lock_guard lock(mutex_);
    std::for_each(questions_.begin(), questions_.end(), refuse);
    in_flight_.clear();
    again_.clear();
    questions_.clear();
}

void LocalExecutor::wake() {
    {
        const std::lock_guard lock(mutex_);
        woken_ = true;
    }
    changed_.notify_all();
}

template <class Answer>
std::future<Reply<Answer>> LocalExecutor::ask(What question) {
    const auto promise = std::make_shared<std::promise<Reply<Answer>>>();
    Work work;
    work.what = std::move(question);
    work.answer = [promise](Outcome outcome) { promise->set_value(reply_of<Answer>(std::move(outcome))); };
    {
        const std::lock_guard lock(mutex_);
        if (draining_ || stopping_)
            work.answer(stopping);
        else
            questions_.push_back(std::move(work));
        woken_ = true;
    }
    changed_.notify_all();
    return promise->get_future();
}

std::future<Reply<worker::MapSummary>> LocalExecutor::inspect(worker::InspectRequest question) {
    return ask<worker::MapSummary>(std::move(question));
}

std::future<Reply<worker::Assessments>> LocalExecutor::assess(worker::AssessRequest question) {
    return ask<worker::Assessments>(std::move(question));
}

void LocalExecutor::run() {
    for (;;) {
        std::deque<Event> events;
        bool stalled = false;
        {
            std::unique_lock lock(mutex_);
            idle_ = in_flight_.empty();
            if (idle_)
                changed_.notify_all();
            const auto news = [this] { return stopping_ || woken_ || !events_.empty(); };
            if (in_flight_.empty())
                changed_.wait(lock, news);
            else
                stalled = !changed_.wait_until(lock, last_news_ + options_.stall_limit, news);
            if (stopping_)
                return;
            idle_ = false;
            woken_ = false;
            events.swap(events_);
        }
        if (stalled)
            handle_death(
                fmt::format("gave no sign for {} s, and was ended,",
                            std::chrono::duration_cast<std::chrono::seconds>(options_.stall_limit).count()));
        for (const Event& event : events)
            handle(event);
        fill_window();
    }
}

void LocalExecutor::handle(const Event& event) {
    if (!worker_ || event.worker != worker_number_)
        return;  // the last words of one that is no longer ours
    if (const auto* answer = std::get_if<worker::Answer>(&event.what))
        handle_answer(*answer);
    else
        handle_death(std::get<std::string>(event.what));
}

void LocalExecutor::handle_answer(const worker::Answer& answer) {
    last_news_ = std::chrono::steady_clock::now();
    const auto found = in_flight_.find(answer.id);
    if (found == in_flight_.end())
        return;
    Work work = std::move(found->second);
    in_flight_.erase(found);
    const auto* failure = std::get_if<worker::RequestFailure>(&answer.what);
    if (failure != nullptr && failure->may_retry)
        retry_or_fail(std::move(work), failure->sentence);
    else
        finish(work, answer.what);
}

void LocalExecutor::handle_death(const std::string& how) {
    spdlog::warn("the worker {} with {} requests in flight", how, in_flight_.size());
    worker_.reset();
    std::map<std::uint64_t, Work> lost;
    lost.swap(in_flight_);
    for (auto& [id, work] : lost) {
        work.alone = true;
        retry_or_fail(std::move(work), fmt::format("the worker {} while at it", how));
    }
}

void LocalExecutor::retry_or_fail(Work work, const std::string& sentence) {
    if (++work.failed_attempts < max_attempts) {
        // Without the earlier result: it may be what the worker cannot bear.
        if (auto* bake = std::get_if<worker::BakeRequest>(&work.what))
            bake->earlier.reset();
        again_.push_back(std::move(work));
        return;
    }
    finish(work,
           worker::RequestFailure{fmt::format("{} (tried {} times)", sentence, work.failed_attempts), false});
}

void LocalExecutor::finish(Work& work, Outcome outcome) {
    if (work.answer)
        work.answer(std::move(outcome));
    else
        callbacks_.finished(
            {*work.sector, work.failed_attempts, reply_of<worker::SectorResult>(std::move(outcome))});
}

}  // namespace drtv::executor
