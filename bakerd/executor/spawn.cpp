#include "bakerd/executor/spawn.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

extern char** environ;

namespace drtv::executor {

std::string describe_exit(int status) {
    if (WIFSIGNALED(status))
        return fmt::format("was ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("ended with status {}", WEXITSTATUS(status));
}

store::Result<Pipe> make_pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return store::fail(store::ErrorCode::internal,
                           fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    return Pipe{store::FileDescriptor(ends[0]), store::FileDescriptor(ends[1])};
}

store::Result<pid_t> spawn(const std::vector<std::string>& command,
                           const Streams& streams,
                           std::span<const std::string> hidden) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const auto hand_over = [&](int file, int as) {
        if (file >= 0)
            posix_spawn_file_actions_adddup2(&actions, file, as);
    };
    hand_over(streams.input, STDIN_FILENO);
    hand_over(streams.output, STDOUT_FILENO);
    hand_over(streams.error, STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setpgroup(&attributes, 0);
    // The daemon blocks the signals it waits for; what it starts must not.
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    std::vector<char*> arguments;
    for (const std::string& argument : command)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    std::vector<char*> variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view text = *variable;
        if (std::ranges::none_of(hidden, [&](const std::string& name) { return text.starts_with(name); }))
            variables.push_back(*variable);
    }
    variables.push_back(nullptr);
    pid_t pid = 0;
    const int error =
        ::posix_spawnp(&pid, arguments[0], &actions, &attributes, arguments.data(), variables.data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
        return store::fail(store::ErrorCode::internal,
                           fmt::format("cannot start {}: {}", command[0], std::strerror(error)));
    return pid;
}

}  // namespace drtv::executor
