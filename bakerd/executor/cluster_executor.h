// Bakes on a cluster; questions are answered on this machine.
#pragma once

#include "bakerd/executor/cluster.h"
#include "bakerd/executor/dispatcher.h"
#include "bakerd/executor/executor.h"
#include "bakerd/executor/local_executor.h"
#include "bakerd/executor/sweeper.h"
#include "bakerd/store/blob_store.h"

#include <chrono>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace drtv::executor {

class ClusterExecutor final : public Executor {
  public:
    // Goes on with the arrays that an earlier run left at work.
    [[nodiscard]] static store::Result<std::unique_ptr<ClusterExecutor>> open(
        std::unique_ptr<Cluster> cluster,
        DispatchOptions options,
        LocalExecutor::Options local,
        store::BlobStore& blobs,
        Callbacks callbacks);

    // Leaves arrays at work.
    ~ClusterExecutor() override;
    ClusterExecutor(const ClusterExecutor&) = delete;
    ClusterExecutor& operator=(const ClusterExecutor&) = delete;

    void wake() override;
    [[nodiscard]] std::optional<ClusterState> cluster() const override;
    [[nodiscard]] std::future<Reply<worker::MapSummary>> inspect(worker::InspectRequest question) override;
    [[nodiscard]] std::future<Reply<worker::Assessments>> assess(worker::AssessRequest question) override;
    void stop(std::chrono::milliseconds patience) override;

  private:
    ClusterExecutor(std::unique_ptr<Cluster> cluster,
                    Dispatcher dispatcher,
                    Sweeper sweeper,
                    LocalExecutor::Options local);
    void run();

    const std::unique_ptr<Cluster> cluster_;
    Dispatcher dispatcher_;  // the thread's only
    LocalExecutor local_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool woken_ = false;     // guarded by mutex_
    bool stopping_ = false;  // guarded by mutex_
    ClusterState state_;     // guarded by mutex_; after the last step

    const Sweeper sweeper_;
    std::thread thread_;
};

}  // namespace drtv::executor
