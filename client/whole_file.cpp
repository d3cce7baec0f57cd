#include "client/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace drtv::client {
namespace {

// 0, or what went wrong, as in errno.
int write_all(int fd, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return n < 0 ? errno : EIO;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return 0;
}

// 0, or what went wrong; then no file is left.
int write_new(const std::string& path, std::string_view bytes) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0)
        return errno;
    int error = write_all(fd, bytes);
    if (::close(fd) != 0 && error == 0)
        error = errno;
    if (error != 0)
        ::unlink(path.c_str());
    return error;
}

}  // namespace

Done write_whole(const std::string& path, const std::string& bytes) {
    const std::string temporary = fmt::format("{}.part{}", path, ::getpid());
    int error = write_new(temporary, bytes);
    if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) {
        error = errno;
        ::unlink(temporary.c_str());
    }
    if (error != 0)
        return cli::fail(cli::exit_unreadable,
                         fmt::format("cannot write {}: {}", path, std::strerror(error)));
    return {};
}

Done make_folder(const std::string& folder) {
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (!code && std::filesystem::is_directory(folder, code))
        return {};
    const std::string why = code ? code.message() : "it is a file";
    return cli::fail(cli::exit_unreadable, fmt::format("cannot make the folder '{}': {}", folder, why));
}

}  // namespace drtv::client
