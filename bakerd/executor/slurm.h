// Slurm by its commands, which stay the same where its library and its JSON change with each release.
#pragma once

#include "bakerd/executor/cluster.h"

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::executor {

struct SlurmOptions {
    std::string account;  // empty: the site's default; likewise the next ones
    std::string partition;
    std::string qos;
    std::string constraint;
    int time_limit_min = 0;              // of a task; 0: the site's default
    int throttle = 0;                    // tasks of an array at work at the same time; 0: no limit
    int threads = 0;                     // of a task; 0: the smallest node's, at most 16
    std::vector<std::string> arguments;  // more for sbatch
    bool resumes_nodes = false;          // that Slurm drained for a "Duplicate jobid": needs its operator
    std::chrono::milliseconds time_limit = std::chrono::seconds(20);  // of one command
};

class Slurm final : public Cluster {
  public:
    explicit Slurm(SlurmOptions options) : options_(std::move(options)) {}

    [[nodiscard]] tl::expected<void, Refusal> submit(const ClusterArray& array) override;
    [[nodiscard]] tl::expected<std::vector<ClusterTask>, std::string> list(
        std::span<const std::string> keys) override;
    [[nodiscard]] tl::expected<ClusterView, std::string> view() override;
    void mend(const ClusterView& view) override;
    void cancel(const std::string& key) override;
    void cancel(std::span<const ClusterTask> tasks) override;
    void nudge(std::span<const ClusterTask> tasks) override;

  private:
    [[nodiscard]] std::string partition() const;
    void step_back(const std::string& job) const;
    [[nodiscard]] tl::expected<std::string, std::string> run(const std::vector<std::string>& command) const;

    const SlurmOptions options_;
};

}  // namespace drtv::executor
