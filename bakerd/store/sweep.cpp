#include "bakerd/store/sweep.h"

#include "bakerd/store/file_descriptor.h"
#include "bakerd/store/temporary_name.h"

#include <fcntl.h>

#include <filesystem>
#include <optional>
#include <system_error>

namespace drtv::store {
namespace {

namespace fs = std::filesystem;

// By the clock of the folder's own machine, which may be another one than ours; nothing where it cannot be
// asked, as on a full disk.
std::optional<fs::file_time_type> now_of(const std::string& folder) {
    const std::string probe = folder + "/" + temporary_name();
    if (!FileDescriptor(::open(probe.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)).is_open())
        return std::nullopt;
    std::error_code code;
    const fs::file_time_type now = fs::last_write_time(probe, code);
    std::error_code ignored;
    fs::remove(probe, ignored);
    return code ? std::nullopt : std::optional(now);
}

bool is_older(const fs::path& path, std::optional<fs::file_time_type> now, std::chrono::hours age) {
    std::error_code code;
    const fs::file_time_type written = fs::last_write_time(path, code);
    return now && !code && *now - written > age;
}

// Whether it is empty now.
bool remove_old_below(const fs::path& folder,
                      fs::file_time_type now,
                      std::chrono::hours age,
                      const std::stop_token& stop) {
    bool is_empty = true;
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        if (stop.stop_requested())
            return false;
        std::error_code ignored;
        if (entry->path().filename() == "tmp") {
            is_empty = false;
            continue;
        }
        const bool is_folder = entry->is_directory(ignored) && !entry->is_symlink(ignored);
        const bool goes =
            is_folder ? remove_old_below(entry->path(), now, age, stop) && is_older(entry->path(), now, age)
                      : is_older(entry->path(), now, age);
        if (!goes || !fs::remove(entry->path(), ignored))
            is_empty = false;
    }
    return is_empty && !code;
}

}  // namespace

void remove_leftovers(const std::string& temporary_folder) {
    const auto now = now_of(temporary_folder);
    std::error_code code;
    for (fs::directory_iterator entry(temporary_folder, code), end; !code && entry != end;
         entry.increment(code)) {
        std::error_code ignored;
        if (is_older(entry->path(), now, std::chrono::hours(24)) ||
            is_of_dead_process(entry->path().filename().string()))
            fs::remove(entry->path(), ignored);
    }
}

void remove_old_files(const std::string& folder, std::chrono::hours age, const std::stop_token& stop) {
    if (const auto now = now_of(folder))
        remove_old_below(folder, *now, age, stop);
}

}  // namespace drtv::store
