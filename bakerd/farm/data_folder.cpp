#include "bakerd/farm/data_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace drtv::farm {

Result<std::unique_ptr<DataFolder>> DataFolder::lock(const std::string& path) {
    std::error_code code;
    std::filesystem::create_directories(path, code);
    if (code)
        return fail(ErrorCode::internal,
                    fmt::format("cannot make the data folder {}: {}", path, code.message()));
    const std::string lock_path = path + "/lock";
    const int fd = ::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd < 0)
        return fail(ErrorCode::internal,
                    fmt::format("cannot write to the data folder {}: {}", path, std::strerror(errno)));
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK) {
            const int error = errno;
            ::close(fd);
            return fail(ErrorCode::internal,
                        fmt::format("cannot lock the data folder {}: {}", path, std::strerror(error)));
        }
        std::array<char, 32> owner{};
        const ssize_t read = ::read(fd, owner.data(), owner.size() - 1);
        ::close(fd);
        return fail(ErrorCode::failed_precondition,
                    fmt::format("the data folder {} is in use by another bakerd{}",
                                path,
                                read > 0 ? fmt::format(" (process {})", owner.data()) : ""));
    }
    const std::string pid = std::to_string(::getpid());
    if (::ftruncate(fd, 0) != 0 || ::write(fd, pid.data(), pid.size()) != static_cast<ssize_t>(pid.size())) {
        const int error = errno;
        ::close(fd);
        return fail(ErrorCode::resource_exhausted,
                    fmt::format("cannot write to the data folder {}: {}", path, std::strerror(error)));
    }
    return std::unique_ptr<DataFolder>(new DataFolder(path, fd));
}

DataFolder::~DataFolder() {
    ::close(fd_);
}

}  // namespace drtv::farm
