// bakerd: parse, wire, run.
#include "bakerd/bake/settings_key.h"
#include "bakerd/farm/farm.h"
#include "bakerd/picture/render_request.h"
#include "bakerd/service/server.h"
#include "bakerd/trace/device.h"
#include "bakerd/worker/run_batch.h"
#include "bakerd/worker/run_worker.h"
#include "format/cli/option_checks.h"
#include "format/cli/parse.h"
#include "format/cli/report.h"
#include "format/cli/version.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

namespace drtv {
namespace {

struct ServeOptions {
    std::string data;
    std::string store;
    std::string listen = "127.0.0.1:7447";
    std::string executor = "local";
    int threads = 0;
    std::int64_t cache_bytes = farm::Farm::Options{}.cache_bytes;
    service::TlsFiles tls;
};

// What the command line says.
struct Arguments {
    ServeOptions serve;
    worker::Options worker;
    worker::BatchOptions batch;
    picture::RenderRequest render;
    // The command. Set when the line has been parsed.
    std::function<cli::Result<cli::ExitCode>()> run;
};

cli::Result<cli::ExitCode> serve(const ServeOptions& options) {
    // Blocked in every thread, so that one place waits for them.
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::signal(SIGPIPE, SIG_IGN);

    if (const auto device = trace::Device::open(); !device)
        return cli::fail(cli::exit_unreadable, device.error());
    const int threads = options.threads > 0
                            ? options.threads
                            : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    farm::Farm::Options farm_options{options.data, {}, threads, options.cache_bytes, options.store};
    farm_options.worker_command = {
        self, "worker", "--blobs", farm_options.blob_folder(), "--threads", std::to_string(threads)};
    auto farm = farm::Farm::open(std::move(farm_options));
    if (!farm)
        return cli::fail(cli::exit_unreadable, farm.error().message);
    auto server = service::Server::start(
        **farm, options.listen, options.tls, {std::string(trace::isa_class()), bake::baker_version});
    if (!server)
        return cli::fail(cli::exit_unreadable, server.error());
    spdlog::info("bakerd listens on {}, keeps its data in {}, bakes on {} threads",
                 (*server)->address(),
                 options.data,
                 threads);

    int signal = 0;
    sigwait(&signals, &signal);
    spdlog::info("stopping: the running sectors are finished or put back");
    // The farm first: calls that wait for it get their answer, and the server need not wait for them.
    (*farm)->stop(std::chrono::seconds(10));
    (*server)->stop();
    spdlog::info("stopped");
    return cli::exit_done;
}

void add_serve(CLI::App& app, Arguments& to) {
    ServeOptions& options = to.serve;
    CLI::App* serve_command = app.add_subcommand("serve", "Serve clients until SIGTERM or ctrl-C");
    serve_command
        ->add_option("--data", options.data, "Local folder for the database, and blobs; made when missing")
        ->required();
    serve_command->add_option(
        "--store", options.store, "Folder for blobs, which may be on a network; default: within --data");
    serve_command
        ->add_option("--listen", options.listen, "Address and port; anything but loopback should have TLS")
        ->capture_default_str();
    serve_command->add_option("--executor", options.executor, "Where sectors are baked")
        ->check(cli::one_of({"local"}))
        ->capture_default_str();
    serve_command->add_option("--threads", options.threads, "Threads to bake with; 0: all")
        ->check(cli::whole_number(0, 1024))
        ->capture_default_str();
    serve_command
        ->add_option(
            "--cache-size",
            options.cache_bytes,
            "Bytes of results to keep, as 500MB or 20GB; above that, the least recently used are evicted")
        ->transform(CLI::AsSizeValue(true))
        ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 62))
        ->capture_default_str();
    serve_command->add_option("--tls-cert", options.tls.certificate, "Server certificate (PEM)");
    serve_command->add_option("--tls-key", options.tls.key, "Its key (PEM)");
    serve_command->add_option(
        "--tls-client-ca", options.tls.client_ca, "Authority that signs clients' certificates (PEM)");
    // CLI11 reads configuration for the whole program; the options of `serve` stand under a line `[serve]`.
    app.set_config("--config", "", "File with options: `name = value` lines below a line `[serve]`")
        ->check(CLI::ExistingFile);
    app.allow_config_extras(CLI::config_extras_mode::error);
    serve_command->configurable()->fallthrough();
    serve_command->callback([&to] { to.run = [&to] { return serve(to.serve); }; });
}

void add_worker(CLI::App& app, Arguments& to) {
    CLI::App* command =
        app.add_subcommand("worker", "Answer requests on standard input (started by the daemon)");
    command->add_option("--blobs", to.worker.blob_folder, "Folder of the blob store")->required();
    command->add_option("--threads", to.worker.threads, "Threads to bake with; 0: all")
        ->check(cli::whole_number(0, 1024));
    command->callback([&to] {
        to.run = [&to]() -> cli::Result<cli::ExitCode> {
            if (auto ran = worker::run_worker(to.worker); !ran)
                return cli::fail(cli::exit_unreadable, ran.error());
            return cli::exit_done;
        };
    });
}

void add_task(CLI::App& app, Arguments& to) {
    worker::BatchOptions& batch = to.batch;
    CLI::App* command = app.add_subcommand("task", "Bake a batch of sectors (started by a cluster)");
    command->add_option("--store", batch.store_folder, "The daemon's --store")->required();
    command->add_option("--array", batch.array, "File that lists the sectors")->required();
    command->add_option("--task", batch.task, "Which of its batches")
        ->envname("SLURM_ARRAY_TASK_ID")
        ->required();
    command->add_option("--threads", batch.threads, "Threads to bake with; 0: all")
        ->envname("SLURM_CPUS_PER_TASK")
        ->check(cli::whole_number(0, 1024));
    command->add_option("--node", batch.node, "Name of this node")->envname("SLURMD_NODENAME");
    command->add_option("--log", batch.log, "File that standard error goes to");
    command->callback([&to] {
        to.run = [&to]() -> cli::Result<cli::ExitCode> {
            if (auto ran = worker::run_batch(to.batch); !ran)
                return cli::fail(cli::exit_unreadable, ran.error());
            return cli::exit_done;
        };
    });
}

void add_render(CLI::App& app, Arguments& to) {
    CLI::App* command = app.add_subcommand("render", "Picture of a map in the light of its sector files");
    picture::add_render(*command, to.render);
    command->callback([&to] { to.run = [&to] { return picture::run_render(to.render); }; });
}

void log_to_standard_error() {
    // Colours only on a terminal, and never against NO_COLOR.
    const bool no_color = std::getenv("NO_COLOR") != nullptr;
    auto log = no_color ? spdlog::stderr_logger_mt("bakerd") : spdlog::stderr_color_mt("bakerd");
    log->set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
    spdlog::set_default_logger(log);
}

}  // namespace
}  // namespace drtv

int main(int argc, char** argv) {
    using namespace drtv;
    // gRPC tells failures in paragraphs of its own; ours are one sentence. The variable, when set, wins.
    ::setenv("GRPC_VERBOSITY", "NONE", 0);
    log_to_standard_error();
    CLI::App app{"bakerd bakes light probes: it takes maps and jobs over gRPC and keeps the sector files.",
                 "bakerd"};
    app.require_subcommand(1);
    app.set_version_flag("--version", cli::version_text("bakerd", trace::isa_class()));
    app.footer("bakerd COMMAND --help lists a command's options.\n\n" + cli::exit_code_help("bakerd"));
    Arguments arguments;
    add_serve(app, arguments);
    add_worker(app, arguments);
    add_task(app, arguments);
    add_render(app, arguments);
    if (const auto ended = cli::parse(app, argc, argv))
        return *ended;
    return cli::end_program(arguments.run());
}
