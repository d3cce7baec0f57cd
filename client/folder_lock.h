// One at a time in a folder.
#pragma once

#include "format/cli/failure.h"

#include <string>

namespace drtv::client {

// Holds an advisory lock on a folder (flock), which a process that is killed gives back. Where the file
// system knows no locks there is none.
class FolderLock {
  public:
    // Waits for others; ctrl-C ends the wait.
    [[nodiscard]] static cli::Result<FolderLock> take(const std::string& folder);
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&&) = delete;

  private:
    explicit FolderLock(int fd) : fd_(fd) {}
    int fd_;
};

}  // namespace drtv::client
