#include "bakerd/store/temporary_name.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <system_error>

namespace drtv::store {
namespace {

std::string host_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

}  // namespace

std::string temporary_name() {
    static std::atomic<std::uint64_t> counter{0};
    static const std::string host = host_name();
    return fmt::format("{}.{}.{}", host, ::getpid(), counter++);
}

bool is_of_dead_process(const std::string& name) {
    const std::string host = host_name() + ".";
    pid_t pid = 0;
    if (!name.starts_with(host) ||
        std::from_chars(name.data() + host.size(), name.data() + name.size(), pid).ec != std::errc())
        return false;
    return pid != ::getpid() && ::kill(pid, 0) != 0 && errno == ESRCH;
}

}  // namespace drtv::store
