// What the dispatcher does about tasks that ended with sectors to bake.
#include "bakerd/executor/dispatcher.h"
#include "bakerd/store/durable_file.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>

namespace drtv::executor {
namespace {

constexpr std::chrono::minutes nodes_stay_excluded(10);

// The sentence with which a task's log ends; it may be longer than what fits into a line of ours.
std::string last_words(const std::string& log) {
    const auto bytes = store::read_all(log);
    return bytes ? store::as_utf8(store::last_line(store::text_of_bytes(*bytes)).substr(0, 300)) : "";
}

// Neither its sectors' nor its node's.
bool is_no_fault(const EndedTask& ended, int losses) {
    if (!ended.last)
        return true;
    // Nodes are shut down with TERM; so is, by some sites, what takes too much memory.
    constexpr int few = 2;
    if (ended.last->state == TaskState::lost)
        return ended.last->exit_status != 128 + SIGTERM || losses < few;
    // Its answer was lost.
    return ended.last->state == TaskState::done && ended.last->exit_status == 0;
}

std::string join(const std::string& what, const std::string& words) {
    return words.empty() ? what : fmt::format("{}: {}", what, words);
}

}  // namespace

// One of another build says so. One on which the tasks of several batches end without an answer lacks
// something, and would draw all that wait. It gets no more for a while.
bool Dispatcher::is_fault_of_node(const EndedTask& ended, const std::string& printed) {
    constexpr std::size_t too_many = 3;
    const ClusterTask& last = *ended.last;
    if (last.state != TaskState::done || last.exit_status == 0)
        return false;
    if (ended.unanswered.size() == ended.sectors)
        barren_[last.node].insert(ended.unanswered.front());
    const bool is_fault =
        last.exit_status == options_.differs_status || barren_[last.node].size() >= too_many;
    if (is_fault)
        excluded_[last.node] = {
            now() + nodes_stay_excluded,
            printed.empty() ? fmt::format("tasks end with status {}", last.exit_status) : printed};
    return is_fault;
}

void Dispatcher::try_again(const std::string& array_key, const Array& array, const EndedTask& ended) {
    const auto state = ended.last ? ended.last->state : TaskState::lost;
    const bool was_refused = !ended.last && !array.was_taken && !array.watch.is_known();
    bool is_of_node = false;
    std::string words = "the cluster lost its tasks";
    std::string log;
    if (ended.last) {
        log = fmt::format("logs/{}/{}.log", ended.last->key, ended.last->number);
        const std::string printed = last_words(options_.store_folder + "/" + log);
        const std::string& node = ended.last->node;
        words = join(fmt::format("its task ended{} as {} (exit status {}; {})",
                                 node.empty() ? "" : " on node " + node,
                                 ended.last->words,
                                 ended.last->exit_status,
                                 log),
                     printed);
        is_of_node = is_fault_of_node(ended, printed);
    }
    for (const Digest& key : ended.unanswered) {
        Sector* const placed = find_placed(key, array_key);
        if (placed == nullptr)
            continue;
        Sector& sector = *placed;
        sector.place.reset();
        if (state == TaskState::out_of_memory)
            costs_.learn_too_little(sector.request, std::max(array.memory_bytes, std::int64_t{1} << 30));
        const bool is_lost = is_of_node || is_no_fault(ended, sector.losses);
        if (is_lost)
            sector.losses += was_refused ? 0 : 1;
        else
            ++sector.failures;
        sector.alone = sector.alone || (ended.sectors > 1 && !is_lost && state != TaskState::cancelled);
        // Without the earlier result: it may be what the worker cannot bear.
        if (sector.failures > 0)
            sector.request.earlier.reset();
        if (sector.failures >= max_attempts || sector.losses >= max_losses)
            finish(key,
                   tl::unexpected(worker::RequestFailure{
                       fmt::format("{} (tried {} times)", words, sector.failures + sector.losses), false}),
                   ended.last ? ended.last->node : "",
                   log);
        else
            fresh_.push_back(key);
    }
}

// Nothing where another array has it since, or nobody wants it.
Dispatcher::Sector* Dispatcher::find_placed(const Digest& key, const std::string& array) {
    const auto found = sectors_.find(key);
    const bool is_there =
        found != sectors_.end() && found->second.place && found->second.place->array == array;
    return is_there ? &found->second : nullptr;
}

bool Dispatcher::is_missed(const std::string& array, const EndedTask& ended) {
    return std::ranges::any_of(ended.unanswered,
                               [&](const Digest& key) { return find_placed(key, array) != nullptr; });
}

}  // namespace drtv::executor
