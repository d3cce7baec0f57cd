// bakerd: parse, wire, run.
#include "bakerd/farm/farm.h"
#include "bakerd/picture/render_request.h"
#include "bakerd/service/server.h"
#include "bakerd/trace/device.h"
#include "bakerd/worker/worker.h"
#include "format/kit/exit_code.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

namespace {

struct ServeOptions {
    std::string data;
    std::string listen = "127.0.0.1:7447";
    std::string executor = "local";
    int threads = 0;
    std::int64_t cache_bytes = drtv::farm::Farm::Options{}.cache_bytes;
    drtv::service::TlsFiles tls;
};

int complain(const std::string& sentence) {
    std::fprintf(stderr, "bakerd: %s\n", sentence.c_str());
    return 1;
}

int serve(const ServeOptions& options) {
    // Blocked in every thread, so that one place waits for them.
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::signal(SIGPIPE, SIG_IGN);

    if (const auto device = drtv::trace::Device::open(); !device)
        return complain(device.error());
    const int threads = options.threads > 0
                            ? options.threads
                            : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    auto farm = drtv::farm::Farm::open(
        {options.data,
         {self, "worker", "--blobs", options.data + "/blobs", "--threads", std::to_string(threads)},
         threads,
         options.cache_bytes});
    if (!farm)
        return complain(farm.error().message);
    auto server = drtv::service::Server::start(**farm, options.listen, options.tls);
    if (!server)
        return complain(server.error());
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
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    // gRPC tells failures in paragraphs of its own; ours are one sentence. The variable, when set, wins.
    ::setenv("GRPC_VERBOSITY", "NONE", 0);
    // Talk goes to standard error; colours only on a terminal, and never against NO_COLOR.
    const bool no_color = std::getenv("NO_COLOR") != nullptr;
    auto log = no_color ? spdlog::stderr_logger_mt("bakerd") : spdlog::stderr_color_mt("bakerd");
    log->set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
    spdlog::set_default_logger(log);

    CLI::App app{"bakerd bakes light probes: it takes maps and jobs over gRPC and keeps the sector files."};
    app.require_subcommand(1);
    app.set_version_flag("--version", "bakerd " DRTV_VERSION);

    ServeOptions serve_options;
    CLI::App* serve_command = app.add_subcommand("serve", "Serve clients until SIGTERM or ctrl-C");
    serve_command
        ->add_option("--data", serve_options.data, "Folder for database and blobs; made when missing")
        ->required();
    serve_command
        ->add_option(
            "--listen", serve_options.listen, "Address and port; anything but loopback should have TLS")
        ->capture_default_str();
    serve_command->add_option("--executor", serve_options.executor, "Where sectors are baked")
        ->check(CLI::IsMember({"local"}))
        ->capture_default_str();
    serve_command->add_option("--threads", serve_options.threads, "Threads to bake with; 0: all")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    serve_command
        ->add_option("--cache-size",
                     serve_options.cache_bytes,
                     "Bytes of results to keep, as 500MB or 20GB; beyond, those used longest ago go")
        ->transform(CLI::AsSizeValue(true))
        ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 62))
        ->capture_default_str();
    serve_command->add_option("--tls-cert", serve_options.tls.certificate, "Server certificate (PEM)");
    serve_command->add_option("--tls-key", serve_options.tls.key, "Its key (PEM)");
    serve_command->add_option(
        "--tls-client-ca", serve_options.tls.client_ca, "Authority that signs clients' certificates (PEM)");
    // CLI11 reads configuration for the whole program; the options of `serve` stand under a line `[serve]`.
    app.set_config("--config", "", "File with options: `name = value` lines below a line `[serve]`")
        ->check(CLI::ExistingFile);
    app.allow_config_extras(CLI::config_extras_mode::error);
    serve_command->configurable()->fallthrough();

    drtv::worker::Options worker_options;
    CLI::App* worker_command =
        app.add_subcommand("worker", "Answer requests on standard input (started by the daemon)");
    worker_command->add_option("--blobs", worker_options.blob_folder, "Folder of the blob store")->required();
    worker_command->add_option("--threads", worker_options.threads, "Threads to bake with; 0: all")
        ->check(CLI::Range(0, 1024));

    drtv::picture::RenderRequest render_request;
    CLI::App* render_command =
        app.add_subcommand("render", "Picture of a map in the light of its sector files");
    drtv::picture::add_render(*render_command, render_request);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0)
            return app.exit(error);  // --help, --version
        const std::string what = app.get_subcommands().empty() && !app.remaining().empty()
                                     ? fmt::format("there is no command '{}'", app.remaining().front())
                                     : error.what();
        if (*render_command) {
            complain("render: " + what + "; bakerd render --help says more");
            return drtv::kit::exit_usage;
        }
        complain(what + "; bakerd --help lists what there is");
        return 2;
    }
    if (*worker_command)
        return drtv::worker::run_worker(worker_options);
    if (*render_command) {
        const int exit_code = drtv::picture::run_render(render_request);
        // A full disk behind a redirected stdout must not look like success.
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
            return exit_code;
        complain("cannot write to standard output");
        return drtv::kit::exit_unreadable;
    }
    return serve(serve_options);
}
