#include "bakerd/executor/slurm.h"

#include "bakerd/executor/run_command.h"
#include "bakerd/executor/slurm_text.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <set>

namespace drtv::executor {
namespace {

using Failure = tl::unexpected<std::string>;

std::string batch_script(const std::vector<std::string>& command) {
    std::string script = "exec";
    for (const std::string& argument : command)
        script += " " + quote(argument);
    return script;
}

std::string name_of(const ClusterTask& task) {
    return fmt::format("{}_{}", task.job, task.number);
}

// Lists of at most a hundred names, until the cluster does not do what it is asked: the rest has its turn
// after the next list.
template <class Command>
void for_each_portion(std::span<const std::string> names, const Command& command) {
    constexpr std::size_t at_once = 100;
    while (!names.empty()) {
        const auto portion = names.first(std::min(at_once, names.size()));
        names = names.subspan(portion.size());
        if (const auto said = command(fmt::format("{}", fmt::join(portion, ","))); !said) {
            spdlog::warn("{}", said.error());
            return;
        }
    }
}

}  // namespace

tl::expected<std::string, std::string> Slurm::run(const std::vector<std::string>& command) const {
    // With these a user tells Slurm what to leave out of its answers.
    static const std::vector<std::string> filters = {"SQUEUE_", "SINFO_", "SCANCEL_"};
    return run_command(command, options_.time_limit, filters);
}

tl::expected<void, Refusal> Slurm::submit(const ClusterArray& array) {
    std::string tasks = fmt::format("--array=0-{}", array.tasks - 1);
    if (options_.throttle > 0)
        tasks += fmt::format("%{}", options_.throttle);
    std::vector<std::string> command = {"sbatch",
                                        "--parsable",
                                        "--job-name=" + array.key,
                                        "--dependency=singleton",
                                        "--requeue",
                                        std::move(tasks),
                                        "--chdir=/",
                                        fmt::format("--output={}/%a.log", array.log_folder),
                                        "--open-mode=append",
                                        // Any other value begins each task with a login shell, which may
                                        // take long.
                                        "--export=ALL"};
    const auto add = [&](const char* name, const std::string& value) {
        if (!value.empty())
            command.push_back(fmt::format("--{}={}", name, value));
    };
    add("account", options_.account);
    add("partition", options_.partition);
    add("qos", options_.qos);
    add("constraint", options_.constraint);
    add("exclude", fmt::format("{}", fmt::join(array.excluded_nodes, ",")));
    if (options_.time_limit_min > 0)
        add("time", std::to_string(options_.time_limit_min));
    add("cpus-per-task", std::to_string(array.threads));
    if (array.memory_bytes > 0)
        add("mem", fmt::format("{}M", (array.memory_bytes + (1 << 20) - 1) >> 20));
    command.insert(command.end(), options_.arguments.begin(), options_.arguments.end());
    command.push_back("--wrap=" + batch_script(array.command));
    const auto said = run(command);
    if (!said)
        return tl::unexpected(Refusal{said.error(), is_too_large(said.error())});
    const auto job = job_number(*said);
    if (!job)
        return tl::unexpected(
            Refusal{fmt::format("sbatch gave no job's number, but {:?}", said->substr(0, 80)), false});
    if (array.priority == Priority::nightly)
        step_back(*job);
    return {};
}

// Behind all interactive arrays. Not by sbatch --nice: priority/basic puts each new job below the lowest one
// that was ever submitted.
void Slurm::step_back(const std::string& job) const {
    if (const auto said = run({"scontrol", "update", "jobid=" + job, "nice=100000"}); !said)
        spdlog::warn("interactive sectors may have to wait for nightly ones: {}", said.error());
}

tl::expected<std::vector<ClusterTask>, std::string> Slurm::list(std::span<const std::string> keys) {
    const auto said =
        run({"squeue",
             "--me",
             "--all",
             "--noheader",
             "--array",
             "--states=all",
             fmt::format("--name={}", fmt::join(keys, ",")),
             "--Format=Name:|,ArrayJobID:|,ArrayTaskID:|,State:|,Reason:|,BatchHost:|,exit_code:|"});
    if (!said)
        return Failure(said.error());
    std::vector<ClusterTask> tasks;
    for (const std::string_view row : rows_of(*said)) {
        auto task = parse_task(row);
        // Half of a list would look as if the other tasks were gone.
        if (!task)
            return Failure(
                fmt::format("squeue gave a row that is none: {}", store::as_utf8(row.substr(0, 80))));
        tasks.push_back(std::move(*task));
    }
    return tasks;
}

// Where sbatch puts tasks; empty: into the default one.
std::string Slurm::partition() const {
    std::string named = options_.partition;
    const std::vector<std::string>& more = options_.arguments;
    for (std::size_t n = 0; n < more.size(); ++n) {
        constexpr std::string_view by_name = "--partition=";
        if ((more[n] == "-p" || more[n] == "--partition") && n + 1 < more.size())
            named = more[n + 1];
        else if (more[n].starts_with(by_name))
            named = more[n].substr(by_name.size());
        else if (more[n].starts_with("-p") && more[n].size() > 2)
            named = more[n].substr(2);
    }
    const char* const site = std::getenv("SBATCH_PARTITION");
    return named.empty() && site != nullptr ? site : named;
}

tl::expected<ClusterView, std::string> Slurm::view() {
    const auto config = run({"scontrol", "show", "config"});
    if (!config)
        return Failure(config.error());
    std::vector<std::string> ask = {"sinfo", "--noheader", "--Node", "--format=%N|%c|%m|%T|%P|%E"};
    const std::string partition = this->partition();
    if (!partition.empty())
        ask.insert(ask.end(), {"--all", "--partition=" + partition});
    const auto nodes = run(ask);
    if (!nodes)
        return Failure(nodes.error());
    ClusterView view;
    // The highest number of a task is one less.
    view.max_tasks = std::min(
        view.max_tasks, std::max(configured(*config, "MaxArraySize").value_or(1001), std::size_t{2}) - 1);
    view.max_tasks = std::clamp(
        configured(*config, "max_array_tasks").value_or(view.max_tasks), std::size_t{1}, view.max_tasks);
    std::vector<NodeRow> rows;
    for (const std::string_view row : rows_of(*nodes)) {
        if (auto parsed = parse_node(row))
            rows.push_back(std::move(*parsed));
    }
    if (partition.empty() && std::ranges::any_of(rows, &NodeRow::is_of_default))
        std::erase_if(rows, [](const NodeRow& row) { return !row.is_of_default; });
    std::set<std::string> known;
    for (NodeRow& row : rows) {
        if (known.insert(row.node.name).second)
            view.nodes.push_back(std::move(row.node));
    }
    int smallest = 16;
    for (const ClusterNode& node : view.nodes)
        smallest = std::min(smallest, std::max(node.threads, 1));
    view.task_threads = options_.threads > 0 ? options_.threads : smallest;
    return view;
}

void Slurm::mend(const ClusterView& view) {
    for (const ClusterNode& node : view.nodes) {
        if (!options_.resumes_nodes || node.reason != "drained: Duplicate jobid")
            continue;
        spdlog::warn("node {} is resumed: it was drained for a \"Duplicate jobid\"", node.name);
        if (const auto said = run({"scontrol", "update", "nodename=" + node.name, "state=resume"}); !said)
            spdlog::warn("{}", said.error());
    }
}

void Slurm::cancel(const std::string& key) {
    if (const auto said = run({"scancel", "--me", "--name=" + key}); !said)
        spdlog::warn("{}", said.error());
}

void Slurm::cancel(std::span<const ClusterTask> tasks) {
    constexpr std::size_t at_once = 1000;
    for (std::size_t first = 0; first < tasks.size(); first += at_once) {
        // By name as well: the job's number may be another's by now.
        std::vector<std::string> command = {"scancel", "--me", "--name=" + tasks[first].key};
        for (const ClusterTask& task : tasks.subspan(first, std::min(at_once, tasks.size() - first)))
            command.push_back(name_of(task));
        if (const auto said = run(command); !said)
            spdlog::warn("{}", said.error());
    }
}

void Slurm::nudge(std::span<const ClusterTask> tasks) {
    std::vector<std::string> held;
    std::vector<std::string> delayed;
    for (const ClusterTask& task : tasks)
        (task.state == TaskState::held ? held : delayed).push_back(name_of(task));
    for_each_portion(held, [this](const std::string& names) { return run({"scontrol", "release", names}); });
    for_each_portion(delayed, [this](const std::string& names) {
        return run({"scontrol", "update", "jobid=" + names, "StartTime=now"});
    });
}

}  // namespace drtv::executor
