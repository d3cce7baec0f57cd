#include "bakerd/worker/run_worker.h"

#include "bakerd/worker/bake_threads.h"
#include "bakerd/worker/protocol.h"
#include "bakerd/worker/worker.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <mutex>

namespace drtv::worker {
namespace {

// The protocol's stream; file descriptor 1 becomes standard error for everyone else.
std::FILE* take_standard_output() {
    const int fd = ::dup(STDOUT_FILENO);
    if (fd < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
        return nullptr;
    return ::fdopen(fd, "w");
}

// Neither is inherited from the daemon, whose own work is light.
void limit_process(const Options& options) {
    if (options.nice > 0)
        ::setpriority(PRIO_PROCESS, 0, options.nice);
    if (options.memory_bytes > 0) {
        // Of what it takes for itself; files that it maps cost nothing.
        const rlimit limit{static_cast<rlim_t>(options.memory_bytes),
                           static_cast<rlim_t>(options.memory_bytes)};
        ::setrlimit(RLIMIT_DATA, &limit);
    }
}

}  // namespace

tl::expected<void, std::string> run_worker(const Options& options) {
    limit_process(options);
    // Dies with the daemon, whatever kills it.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::FILE* out = take_standard_output();
    auto worker = Worker::open(options.blob_folder);
    if (!worker)
        return tl::unexpected(worker.error());
    if (out == nullptr)
        return tl::unexpected(std::string("cannot take over standard output"));
    std::mutex out_mutex;
    const auto answer = [&](const Request& request) {
        const std::string line = encode((*worker)->answer(request));
        const std::lock_guard lock(out_mutex);
        std::fprintf(out, "%s\n", line.c_str());
        std::fflush(out);
    };
    BakeThreads threads(options.threads);
    std::string line;
    while (std::getline(std::cin, line)) {
        const auto request = decode_request(line);
        if (!request)
            return tl::unexpected("the worker was sent a line it does not understand: " +
                                  line.substr(0, 200));
        threads.enqueue([&answer, request = *request] { answer(request); }, request->rank);
    }
    // The daemon has gone or wants no more: what is left has no reader.
    std::fflush(out);
    std::_Exit(0);
}

}  // namespace drtv::worker
