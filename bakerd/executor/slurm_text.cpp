#include "bakerd/executor/slurm_text.h"

#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <map>
#include <ranges>

namespace drtv::executor {
namespace {

std::vector<std::string_view> columns_of(std::string_view row) {
    std::vector<std::string_view> columns;
    for (const auto column : std::views::split(row, '|'))
        columns.emplace_back(column.begin(), column.end());
    return columns;
}

template <class Number>
std::optional<Number> number(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    // Slurm writes "16+" for nodes that differ.
    if (error != std::errc() || (end != text.data() + text.size() && *end != '+'))
        return std::nullopt;
    return value;
}

TaskState state_of_waiting(std::string_view reason) {
    // A task whose node was lost waits out a time in which its old copy might live; ours may have copies.
    if (reason == "BeginTime")
        return TaskState::delayed;
    // "launch failed requeued held", "JobHeldUser", "JobHeldAdmin".
    if (reason.find("requeued held") != reason.npos || reason.starts_with("JobHeld"))
        return TaskState::held;
    return TaskState::waiting;
}

std::optional<TaskState> state_of(std::string_view state, std::string_view reason) {
    if (state == "PENDING")
        return state_of_waiting(reason);
    // Requeued so often that Slurm leaves it to people (max_batch_requeue).
    if (state == "REQUEUE_HOLD" || state == "SPECIAL_EXIT")
        return TaskState::held;
    // One word each; a state that a later Slurm adds counts as alive.
    static const std::map<std::string_view, TaskState> ended = {
        {"COMPLETED", TaskState::done},
        {"FAILED", TaskState::done},
        {"CANCELLED", TaskState::cancelled},
        {"DEADLINE", TaskState::cancelled},
        {"REVOKED", TaskState::cancelled},
        {"NODE_FAIL", TaskState::lost},
        {"BOOT_FAIL", TaskState::lost},
        {"PREEMPTED", TaskState::lost},
        {"TIMEOUT", TaskState::overtime},
        {"OUT_OF_MEMORY", TaskState::out_of_memory},
    };
    const auto found = ended.find(state);
    if (found != ended.end())
        return found->second;
    const bool is_word = !state.empty() && std::ranges::all_of(state, [](char letter) {
        return (letter >= 'A' && letter <= 'Z') || letter == '_';
    });
    return is_word ? std::optional(TaskState::running) : std::nullopt;
}

}  // namespace

bool is_too_large(std::string_view sentence) {
    constexpr std::array<std::string_view, 6> words = {"job array specification",
                                                       "MaxSubmitJob",
                                                       "job queue full",
                                                       "temporarily unable to accept job",
                                                       "Job violates accounting/QOS policy",
                                                       "Resource temporarily unavailable"};
    return std::ranges::any_of(words,
                               [&](std::string_view word) { return sentence.find(word) != sentence.npos; });
}

std::optional<std::size_t> configured(std::string_view text, std::string_view name) {
    const std::size_t found = text.find(name);
    if (found == text.npos)
        return std::nullopt;
    std::string_view value = text.substr(found + name.size());
    value.remove_prefix(std::min(value.find_first_not_of(" ="), value.size()));
    return number<std::size_t>(value.substr(0, value.find_first_of(" ,\n")));
}

std::optional<NodeRow> parse_node(std::string_view row) {
    const std::vector<std::string_view> columns = columns_of(row);
    if (columns.size() != 6)
        return std::nullopt;
    NodeRow parsed;
    parsed.is_of_default = columns[4].ends_with('*');
    ClusterNode& node = parsed.node;
    node.name = columns[0];
    node.threads = number<int>(columns[1]).value_or(0);
    node.memory_bytes = number<std::int64_t>(columns[2]).value_or(0) << 20;
    std::string_view state = columns[3];
    // A sign says more of it (sinfo(1)): "*" that it does not answer, "-", "+" and "@" nothing that matters,
    // the others that it sleeps, and wakes for a task.
    if (!state.empty() && std::string_view("-+@~#%").find(state.back()) != state.npos)
        state.remove_suffix(1);
    constexpr std::array<std::string_view, 5> up = {"idle", "mixed", "allocated", "completing", "planned"};
    node.is_up = std::ranges::find(up, state) != up.end();
    if (!node.is_up)
        node.reason =
            columns[5] == "none" ? std::string(columns[3]) : fmt::format("{}: {}", columns[3], columns[5]);
    return parsed;
}

std::optional<std::string> job_number(std::string_view text) {
    const std::string_view job = text.substr(0, text.find_first_of(";\n"));
    return number<std::int64_t>(job) ? std::optional(std::string(job)) : std::nullopt;
}

std::vector<std::string_view> rows_of(std::string_view text) {
    std::vector<std::string_view> rows = store::lines_of(text);
    std::erase(rows, std::string_view());
    return rows;
}

std::string quote(const std::string& argument) {
    std::string quoted = "'";
    for (const char letter : argument)
        quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return quoted + "'";
}

std::optional<ClusterTask> parse_task(std::string_view row) {
    const std::vector<std::string_view> columns = columns_of(row);
    if (columns.size() < 7)
        return std::nullopt;
    const auto index = number<std::size_t>(columns[2]);
    const auto state = state_of(columns[3], columns[4]);
    const auto status = number<int>(columns[6]);
    if (columns[0].empty() || columns[1].empty() || !index || !state || !status)
        return std::nullopt;
    ClusterTask task;
    task.key = columns[0];
    task.job = columns[1];
    task.number = *index;
    task.state = *state;
    task.words =
        columns[4] == "None" ? std::string(columns[3]) : fmt::format("{} ({})", columns[3], columns[4]);
    task.node = columns[5];
    task.exit_status = WIFEXITED(*status) ? WEXITSTATUS(*status) : 128 + WTERMSIG(*status);
    // A node that is shut down ends its tasks before Slurm knows that it is gone.
    if (task.state == TaskState::done && task.exit_status == 128 + SIGTERM)
        task.state = TaskState::lost;
    return task;
}

}  // namespace drtv::executor
