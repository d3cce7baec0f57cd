// Starts programs, as posix_spawn does it: no copy of the daemon's memory, no inherited file.
#pragma once

#include "bakerd/store/error.h"
#include "bakerd/store/file_descriptor.h"

#include <sys/types.h>

#include <span>
#include <string>
#include <vector>

namespace drtv::executor {

struct Pipe {
    store::FileDescriptor read;
    store::FileDescriptor write;
};

[[nodiscard]] store::Result<Pipe> make_pipe();

// Files that the program has as its own; -1: the daemon's.
struct Streams {
    int input = -1;
    int output = -1;
    int error = -1;
};

// In a process group of its own, named like the process: ctrl-C in the daemon's terminal is the daemon's to
// handle. A program's name without a slash is looked up in PATH. Variables of the environment whose names
// begin with what is `hidden` are not handed on.
[[nodiscard]] store::Result<pid_t> spawn(const std::vector<std::string>& command,
                                         const Streams& streams,
                                         std::span<const std::string> hidden = {});

// "ended with status 3", "was ended by signal 9 (Killed)"; `status` as waitpid gives it.
[[nodiscard]] std::string describe_exit(int status);

}  // namespace drtv::executor
