// Names of files that are being written.
#pragma once

#include <string>

namespace drtv::store {

// Unique among the living threads and processes of all machines that share the folder; a dead one may have
// left the same name behind.
[[nodiscard]] std::string temporary_name();

// Whether it is the name of a process of this machine that has ended since.
[[nodiscard]] bool is_of_dead_process(const std::string& name);

}  // namespace drtv::store
