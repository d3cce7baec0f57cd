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

store::Result<std::unique_ptr<DataFolder>> DataFolder::lock(const std::string& path) {
    std::error_code code;
    std::filesystem::create_directories(path, code);
    if (code)
        return store::fail(store::ErrorCode::internal,
                           fmt::format("cannot make the data folder {}: {}", path, code.message()));
    const auto cannot = [&](store::ErrorCode kind, const char* what) {
        return store::fail(kind,
                           fmt::format("cannot {} the data folder {}: {}", what, path, std::strerror(errno)));
    };
    const std::string lock_path = path + "/lock";
    store::FileDescriptor file(::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!file.is_open())
        return cannot(store::ErrorCode::internal, "write to");
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK)
            return cannot(store::ErrorCode::internal, "lock");
        std::array<char, 32> owner{};
        const ssize_t read = ::read(file.get(), owner.data(), owner.size() - 1);
        return store::fail(store::ErrorCode::failed_precondition,
                           fmt::format("the data folder {} is in use by another bakerd{}",
                                       path,
                                       read > 0 ? fmt::format(" (process {})", owner.data()) : ""));
    }
    const std::string pid = std::to_string(::getpid());
    const auto size = static_cast<ssize_t>(pid.size());
    if (::ftruncate(file.get(), 0) != 0 || ::write(file.get(), pid.data(), pid.size()) != size)
        return cannot(store::ErrorCode::resource_exhausted, "write to");
    return std::unique_ptr<DataFolder>(new DataFolder(path, std::move(file)));
}

}  // namespace drtv::farm
