#include "bakerd/executor/run_command.h"

#include "bakerd/executor/spawn.h"
#include "bakerd/store/text_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <optional>
#include <thread>

namespace drtv::executor {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// The queue of a large farm is some megabytes.
constexpr std::size_t max_output_bytes = std::size_t{64} << 20;

struct Output {
    store::FileDescriptor file;
    std::string text;
};

milliseconds left_until(Clock::time_point end) {
    return std::chrono::ceil<milliseconds>(std::max(end - Clock::now(), Clock::duration(0)));
}

// False at its end.
bool read_some(Output& output) {
    std::array<char, 65536> buffer;
    const ssize_t n = ::read(output.file.get(), buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR)
        return true;
    if (n <= 0)
        return false;
    if (output.text.size() < max_output_bytes)
        output.text.append(buffer.data(), static_cast<std::size_t>(n));
    return true;
}

// False where the time was over before their ends.
bool read_to_end(std::array<Output, 2>& outputs, Clock::time_point end) {
    for (;;) {
        std::array<pollfd, 2> files{};
        bool open = false;
        for (std::size_t n = 0; n < outputs.size(); ++n) {
            files[n] = {outputs[n].file.get(), POLLIN, 0};
            open = open || outputs[n].file.get() >= 0;
        }
        if (!open)
            return true;
        const milliseconds left = left_until(end);
        const int ready = ::poll(files.data(), files.size(), static_cast<int>(left.count()));
        if (left.count() == 0)
            return false;
        for (std::size_t n = 0; ready > 0 && n < outputs.size(); ++n) {
            if (files[n].revents != 0 && !read_some(outputs[n]))
                outputs[n].file = store::FileDescriptor();
        }
    }
}

// The status of a process that ended in time.
std::optional<int> wait_until(pid_t pid, Clock::time_point end) {
    for (milliseconds pause(1);; pause = std::min(2 * pause, milliseconds(50))) {
        int status = 0;
        if (::waitpid(pid, &status, WNOHANG) == pid)
            return status;
        if (Clock::now() >= end)
            return std::nullopt;
        std::this_thread::sleep_for(pause);
    }
}

}  // namespace

tl::expected<std::string, std::string> run_command(const std::vector<std::string>& command,
                                                   milliseconds time_limit,
                                                   std::span<const std::string> hidden) {
    const Clock::time_point end = Clock::now() + time_limit;
    const store::FileDescriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    auto output = make_pipe();
    if (!output)
        return tl::unexpected(output.error().message);
    auto error = make_pipe();
    if (!error)
        return tl::unexpected(error.error().message);
    const auto pid = spawn(command, {nothing.get(), output->write.get(), error->write.get()}, hidden);
    if (!pid)
        return tl::unexpected(pid.error().message);
    output->write = store::FileDescriptor();
    error->write = store::FileDescriptor();
    std::array<Output, 2> outputs{Output{std::move(output->read), {}}, Output{std::move(error->read), {}}};
    const auto status = read_to_end(outputs, end) ? wait_until(*pid, end) : std::nullopt;
    if (!status) {
        ::kill(-*pid, SIGKILL);
        ::waitpid(*pid, nullptr, 0);
    }
    if (status == 0)
        return std::move(outputs[0].text);
    const std::string how =
        status ? describe_exit(*status) : fmt::format("was not done after {} ms", time_limit.count());
    const std::string why = store::as_utf8(store::last_line(outputs[1].text));
    return tl::unexpected(fmt::format("{} {}{}{}", command[0], how, why.empty() ? "" : ": ", why));
}

}  // namespace drtv::executor
