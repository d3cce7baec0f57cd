// What Slurm's commands print, and what its shell reads.
#pragma once

#include "bakerd/executor/cluster.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::executor {

// A row of squeue, `Name|ArrayJobID|ArrayTaskID|State|Reason|BatchHost|exit_code|`; nothing where it is none.
[[nodiscard]] std::optional<ClusterTask> parse_task(std::string_view row);

// A row of sinfo, `%N|%c|%m|%T|%P|%E`; likewise. There is one for each partition that a node is in.
struct NodeRow {
    ClusterNode node;
    bool is_of_default = false;  // the row's partition is the one that tasks go to which name none
};
[[nodiscard]] std::optional<NodeRow> parse_node(std::string_view row);

// The value of "Name = value" in what scontrol shows.
[[nodiscard]] std::optional<std::size_t> configured(std::string_view text, std::string_view name);

// Of "<job>" or "<job>;<cluster>"; nothing where it is none.
[[nodiscard]] std::optional<std::string> job_number(std::string_view text);

// A refusal, as Slurm words it (its error numbers' sentences), that fewer tasks may pass.
[[nodiscard]] bool is_too_large(std::string_view sentence);

// Lines that are not empty.
[[nodiscard]] std::vector<std::string_view> rows_of(std::string_view text);

// For a shell.
[[nodiscard]] std::string quote(const std::string& argument);

}  // namespace drtv::executor
