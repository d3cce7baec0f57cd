#include "bakerd/store/temporary_name.h"

#include "bakerd/store/host_name.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>

namespace drtv::store {
namespace {

// In which a process's number means this process: machines and containers may have one name, and a machine
// that has started again gives its numbers again.
std::string find_machine() {
    std::ifstream file("/proc/sys/kernel/random/boot_id");
    std::string boot;
    std::getline(file, boot);
    struct stat processes {};
    const bool is_known = ::stat("/proc/self/ns/pid", &processes) == 0;
    return fmt::format("{}-{}-{}", host_name(), boot.substr(0, 8), is_known ? processes.st_ino : 0);
}

const std::string& machine() {
    static const std::string here = find_machine();
    return here;
}

}  // namespace

std::string temporary_name() {
    static std::atomic<std::uint64_t> counter{0};
    return fmt::format("{}.{}.{}", machine(), ::getpid(), counter++);
}

bool is_of_dead_process(const std::string& name) {
    const std::string here = machine() + ".";
    pid_t pid = 0;
    if (!name.starts_with(here) ||
        std::from_chars(name.data() + here.size(), name.data() + name.size(), pid).ec != std::errc())
        return false;
    return pid != ::getpid() && ::kill(pid, 0) != 0 && errno == ESRCH;
}

}  // namespace drtv::store
