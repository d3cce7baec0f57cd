#include "bakerd/farm/open_executor.h"

#include "bakerd/executor/cluster_executor.h"
#include "bakerd/executor/local_executor.h"

#include <utility>

namespace drtv::farm {

double turn_s(const ExecutorOptions& options) {
    if (!options.slurm)
        return 10.0 * options.threads;
    constexpr int usual_threads = 16;
    return options.batch_s * (options.slurm->threads > 0 ? options.slurm->threads : usual_threads);
}

store::Result<std::unique_ptr<executor::Executor>> open_executor(const ExecutorOptions& options,
                                                                 const std::string& store_folder,
                                                                 const std::string& owner,
                                                                 store::BlobStore& blobs,
                                                                 executor::Executor::Callbacks callbacks) {
    executor::LocalExecutor::Options local{.worker_command = options.worker_command,
                                           .threads = options.threads};
    if (!options.slurm)
        return std::make_unique<executor::LocalExecutor>(std::move(local), std::move(callbacks));
    executor::DispatchOptions dispatch;
    dispatch.store_folder = store_folder;
    dispatch.owner = owner;
    dispatch.task_command = options.task_command;
    dispatch.differs_status = options.differs_status;
    dispatch.batch_s = options.batch_s;
    if (options.slurm->time_limit_min > 0)
        dispatch.max_batch_s = options.slurm->time_limit_min * 60.0 / 4;
    return executor::ClusterExecutor::open(std::make_unique<executor::Slurm>(*options.slurm),
                                           std::move(dispatch),
                                           std::move(local),
                                           blobs,
                                           std::move(callbacks));
}

}  // namespace drtv::farm
