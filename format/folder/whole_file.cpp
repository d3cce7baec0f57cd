#include "whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <system_error>

namespace drtv::folder {
namespace {

namespace fs = std::filesystem;

tl::unexpected<cli::Failure> cannot_write(const std::string& path, const std::string& why) {
    return cli::fail(cli::exit_unreadable, "cannot write " + path + ": " + why);
}

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
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return errno;
    int error = write_all(fd, bytes);
    if (::close(fd) != 0 && error == 0)
        error = errno;
    if (error != 0)
        ::unlink(path.c_str());
    return error;
}

// A process number would not do: two containers with one folder have processes of the same number.
std::string temporary_name(const std::string& path) {
    static thread_local std::mt19937_64 random = [] {
        std::random_device device;
        return std::mt19937_64((std::uint64_t{device()} << 32) ^ device());
    }();
    char suffix[32];
    std::snprintf(suffix, sizeof suffix, ".part%016llx", static_cast<unsigned long long>(random()));
    return path + suffix;
}

}  // namespace

cli::Result<void> write_whole(const std::string& link, std::string_view bytes) {
    std::error_code code;
    const bool is_link = fs::is_symlink(link, code);
    const std::string path = is_link ? fs::weakly_canonical(link, code).string() : link;
    const fs::file_status status = fs::status(path, code);
    if (fs::exists(status) && !fs::is_regular_file(status))
        return cannot_write(link, "it is not a regular file");
    return put_whole(path, bytes);
}

cli::Result<void> put_whole(const std::string& path, std::string_view bytes) {
    const std::string temporary = temporary_name(path);
    int error = write_new(temporary, bytes);
    if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) {
        error = errno;
        ::unlink(temporary.c_str());
    }
    if (error != 0)
        return cannot_write(path, std::strerror(error));
    return {};
}

cli::Result<std::string> read_whole(const std::string& path) {
    const auto fail = [&](const std::string& why) {
        return cli::fail(cli::exit_unreadable, "cannot read " + path + ": " + why);
    };
    std::error_code code;
    if (fs::is_directory(path, code))
        return fail("it is a folder");
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return fail(std::strerror(errno));
    std::string text;
    std::array<char, 65536> buffer{};
    while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0)
        text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    return file.bad() ? cli::Result<std::string>(fail(std::strerror(errno))) : text;
}

cli::Result<void> make_folder(const std::string& folder) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code || !fs::is_directory(folder, code)) {
        const std::string why = code ? code.message() : "it is a file";
        return cli::fail(cli::exit_unreadable, "cannot make the folder '" + folder + "': " + why);
    }
    const std::string trial = temporary_name(folder + "/trial");
    const int error = write_new(trial, "");
    ::unlink(trial.c_str());
    if (error != 0)
        return cli::fail(cli::exit_unreadable,
                         "cannot write to the folder '" + folder + "': " + std::strerror(error));
    return {};
}

void remove_leftovers(const std::string& folder) {
    constexpr std::chrono::minutes old{10};
    std::error_code code;
    const auto now = fs::file_time_type::clock::now();
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        const bool is_part = name.starts_with("sector") && name.find(".part") != std::string::npos;
        std::error_code ignored;
        if (is_part && now - entry->last_write_time(ignored) > old)
            fs::remove(entry->path(), ignored);
    }
}

cli::Result<void> sync_folder(const std::string& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool synced = fd >= 0 && ::syncfs(fd) == 0;
    const int error = errno;
    if (fd >= 0)
        ::close(fd);
    if (!synced)
        return cannot_write(folder, std::strerror(error));
    return {};
}

}  // namespace drtv::folder
