// Takes away what nobody will read any more from folders that several machines may share.
#pragma once

#include <chrono>
#include <stop_token>
#include <string>

namespace drtv::store {

// Temporary files of this machine's processes that died at work, and of any machine's after a day.
void remove_leftovers(const std::string& temporary_folder);

// Files at any depth that were written longer ago, and folders that are empty since; none in "tmp". Ends
// early where it is to stop.
void remove_old_files(const std::string& folder, std::chrono::hours age, const std::stop_token& stop = {});

}  // namespace drtv::store
