#include "client/folder_lock.h"

#include "client/interrupt.h"
#include "format/cli/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

namespace drtv::client {

cli::Result<FolderLock> FolderLock::take(const std::string& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0)
        return cli::fail(cli::exit_unreadable,
                         fmt::format("cannot read the folder {}: {}", folder, std::strerror(errno)));
    FolderLock lock(fd);
    bool told = false;
    while (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK && errno != EINTR)
            break;  // there are no locks here
        if (interrupted())
            return cli::fail(cli::exit_interrupted, "interrupted while another pull writes to " + folder);
        if (!told)
            cli::note(fmt::format("another pull writes to {}; waiting for it", folder));
        told = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return lock;
}

FolderLock::~FolderLock() {
    if (fd_ >= 0)
        ::close(fd_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

}  // namespace drtv::client
