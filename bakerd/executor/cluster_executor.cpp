#include "bakerd/executor/cluster_executor.h"

#include <optional>
#include <utility>

namespace drtv::executor {

store::Result<std::unique_ptr<ClusterExecutor>> ClusterExecutor::open(std::unique_ptr<Cluster> cluster,
                                                                      DispatchOptions options,
                                                                      LocalExecutor::Options local,
                                                                      store::BlobStore& blobs,
                                                                      Callbacks callbacks) {
    const std::string store_folder = options.store_folder;
    const std::string owner = options.owner;
    auto dispatcher = Dispatcher::open(std::move(options), *cluster, blobs, std::move(callbacks));
    if (!dispatcher)
        return tl::unexpected(dispatcher.error());
    return std::unique_ptr<ClusterExecutor>(new ClusterExecutor(
        std::move(cluster), std::move(*dispatcher), Sweeper(store_folder, owner), std::move(local)));
}

ClusterExecutor::ClusterExecutor(std::unique_ptr<Cluster> cluster,
                                 Dispatcher dispatcher,
                                 Sweeper sweeper,
                                 LocalExecutor::Options local)
    : cluster_(std::move(cluster)),
      dispatcher_(std::move(dispatcher)),
      local_(std::move(local), {[](Priority) { return std::nullopt; }, {}, {}, {}}),
      sweeper_(std::move(sweeper)),
      thread_([this] { run(); }) {}

ClusterExecutor::~ClusterExecutor() {
    stop(std::chrono::milliseconds(0));
}

void ClusterExecutor::stop(std::chrono::milliseconds patience) {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable())
        thread_.join();
    local_.stop(patience);
}

void ClusterExecutor::wake() {
    {
        const std::lock_guard lock(mutex_);
        woken_ = true;
    }
    changed_.notify_all();
}

std::optional<ClusterState> ClusterExecutor::cluster() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

std::future<Reply<worker::MapSummary>> ClusterExecutor::inspect(worker::InspectRequest question) {
    return local_.inspect(std::move(question));
}

std::future<Reply<worker::Assessments>> ClusterExecutor::assess(worker::AssessRequest question) {
    return local_.assess(std::move(question));
}

void ClusterExecutor::run() {
    std::unique_lock lock(mutex_);
    // Whoever made us may not be ready to be called.
    changed_.wait(lock, [this] { return woken_ || stopping_; });
    while (!stopping_) {
        woken_ = false;
        lock.unlock();
        const Dispatcher::Time due = dispatcher_.step();
        ClusterState state = dispatcher_.state();
        lock.lock();
        state_ = std::move(state);
        changed_.wait_until(lock, due, [this] { return woken_ || stopping_; });
    }
}

}  // namespace drtv::executor
