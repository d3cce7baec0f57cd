#include "bakerd/executor/sweeper.h"

#include "bakerd/store/sweep.h"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <utility>

namespace drtv::executor {
namespace {

constexpr std::chrono::hours lost_answers_stay(24 * 7);
constexpr std::chrono::hours logs_stay(24 * 30);
constexpr std::chrono::hours sweep_every(24);

void sweep(const std::string& store, const std::string& owner, const std::stop_token& stop) {
    store::remove_leftovers(store + "/answers/tmp");
    store::remove_leftovers(fmt::format("{}/arrays/{}/tmp", store, owner));
    // Of tasks that ended after their array had been closed.
    store::remove_old_files(store + "/answers", lost_answers_stay, stop);
    store::remove_old_files(store + "/logs", logs_stay, stop);
}

void sweep_daily(const std::stop_token& stop, const std::string& store, const std::string& owner) {
    std::mutex mutex;
    std::condition_variable_any stopped;
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
        sweep(store, owner, stop);
        stopped.wait_for(lock, stop, sweep_every, [] { return false; });
    }
}

}  // namespace

Sweeper::Sweeper(std::string store_folder, std::string owner)
    : thread_(sweep_daily, std::move(store_folder), std::move(owner)) {}

}  // namespace drtv::executor
