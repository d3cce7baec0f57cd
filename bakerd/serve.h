// The command `bakerd serve`.
#pragma once

#include "bakerd/executor/slurm.h"
#include "bakerd/farm/farm.h"
#include "bakerd/service/server.h"
#include "format/cli/failure.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>

namespace drtv {

struct ServeOptions {
    std::string data;
    std::string store;
    std::string listen = "127.0.0.1:7447";
    std::string executor = "local";
    executor::SlurmOptions slurm;
    std::string task_program;  // bakerd as the nodes see it; empty: this one
    double batch_s = farm::ExecutorOptions{}.batch_s;
    int threads = 0;
    std::int64_t worker_memory_bytes = 0;  // 0: no limit
    int worker_nice = 10;
    std::int64_t cache_bytes = farm::Farm::Options{}.cache_bytes;
    service::TlsFiles tls;

    [[nodiscard]] bool is_on_slurm() const { return executor == "slurm"; }
};

// `chosen` is called when the line names this command.
void add_serve(CLI::App& app, ServeOptions& options, std::function<void()> chosen);

// Until SIGTERM or SIGINT.
[[nodiscard]] cli::Result<cli::ExitCode> serve(const ServeOptions& options);

}  // namespace drtv
