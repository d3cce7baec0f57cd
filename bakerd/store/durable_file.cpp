#include "bakerd/store/durable_file.h"

#include "bakerd/store/file_descriptor.h"
#include "bakerd/store/temporary_name.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace drtv::store {
namespace {

bool sync_folder(const std::string& folder) {
    const FileDescriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    return file.is_open() && ::fsync(file.get()) == 0;
}

std::string folder_of(const std::string& path) {
    return path.substr(0, path.rfind('/'));
}

}  // namespace

tl::unexpected<Error> file_error(const std::string& what, const std::string& path) {
    const int code = errno;
    const ErrorCode kind =
        code == ENOSPC || code == EDQUOT ? ErrorCode::resource_exhausted : ErrorCode::internal;
    return fail(kind, fmt::format("cannot {} {}: {}", what, path, std::strerror(code)));
}

Result<void> make_folder(const std::string& path) {
    std::error_code code;
    std::filesystem::create_directories(path, code);
    if (code)
        return fail(ErrorCode::internal, fmt::format("cannot make the folder {}: {}", path, code.message()));
    return {};
}

bool write_all(int fd, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
}

Result<std::vector<std::uint8_t>> read_all(const std::string& path) {
    const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status {};
    if (!file.is_open() || ::fstat(file.get(), &status) != 0)
        return file_error("read", path);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(status.st_size));
    std::size_t at = 0;
    while (at < bytes.size()) {
        const ssize_t n = ::read(file.get(), bytes.data() + at, bytes.size() - at);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return file_error("read", path);
        if (n == 0)
            bytes.resize(at);  // cut short meanwhile: the digest will tell
        at += static_cast<std::size_t>(n);
    }
    return bytes;
}

Result<void> rename_durably(const std::string& temporary, const std::string& path) {
    const std::string folder = folder_of(path);
    if (::mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST)
        return file_error("make the folder", folder);
    if (::rename(temporary.c_str(), path.c_str()) != 0)
        return file_error("write", path);
    if (!sync_folder(folder) || !sync_folder(folder_of(folder)))
        return file_error("sync", folder);
    return {};
}

Result<void> write_durably(const std::string& temporary_folder,
                           const std::string& path,
                           std::span<const std::uint8_t> bytes) {
    std::string temporary;
    FileDescriptor file;
    do {
        temporary = temporary_folder + "/" + temporary_name();
        file.reset(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    } while (!file.is_open() && errno == EEXIST);
    if (!file.is_open())
        return file_error("write", temporary);
    const bool written = write_all(file.get(), bytes) && ::fsync(file.get()) == 0;
    if (!written || ::close(file.release()) != 0) {
        auto error = file_error("write", temporary);
        ::unlink(temporary.c_str());
        return error;
    }
    auto renamed = rename_durably(temporary, path);
    if (!renamed)
        ::unlink(temporary.c_str());
    return renamed;
}

}  // namespace drtv::store
