#include "bakerd/serve.h"

#include "bakerd/bake/settings_key.h"
#include "bakerd/executor/run_command.h"
#include "bakerd/trace/device.h"
#include "format/cli/option_checks.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>
#include <utility>

namespace drtv {
namespace {

farm::ExecutorOptions executor_options(const ServeOptions& options,
                                       const std::string& store_folder,
                                       const std::string& blob_folder,
                                       int threads) {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    farm::ExecutorOptions executor;
    executor.worker_command = {self,
                               "worker",
                               "--blobs",
                               blob_folder,
                               "--threads",
                               std::to_string(threads),
                               "--memory",
                               std::to_string(options.worker_memory_bytes),
                               "--nice",
                               std::to_string(options.worker_nice)};
    executor.threads = threads;
    if (!options.is_on_slurm())
        return executor;
    executor.slurm = options.slurm;
    executor.batch_s = options.batch_s;
    executor.differs_status = cli::exit_differs;
    executor.task_command = {
        options.task_program.empty() ? self : options.task_program, "task", "--store", store_folder};
    return executor;
}

// With less a worker cannot begin.
CLI::Validator worker_memory_check() {
    return {[](const std::string& text) {
                constexpr std::int64_t least = 256'000'000;
                const std::int64_t bytes = std::stoll(text);
                return bytes == 0 || bytes >= least ? "" : "at least 256MB, or 0 for no limit";
            },
            ""};
}

void add_slurm(CLI::App& command, ServeOptions& options) {
    executor::SlurmOptions& slurm = options.slurm;
    const auto add = [&command](const char* name, auto& value, const char* help) {
        return command.add_option(name, value, help)->group("With --executor slurm")->capture_default_str();
    };
    add("--slurm-account", slurm.account, "Account that pays");
    add("--slurm-partition", slurm.partition, "Partition to bake in");
    add("--slurm-qos", slurm.qos, "Quality of service");
    add("--slurm-constraint", slurm.constraint, "Features that nodes must have");
    add("--slurm-time-limit", slurm.time_limit_min, "Minutes that a task may take; 0: the site's default")
        ->check(cli::whole_number(0, 1'000'000));
    add("--slurm-throttle", slurm.throttle, "Tasks of an array at work at the same time; 0: no limit")
        ->check(cli::whole_number(0, 1'000'000));
    add("--slurm-threads", slurm.threads, "Threads of a task; 0: those of the smallest node, at most 16")
        ->check(cli::whole_number(0, 1024));
    add("--slurm-batch",
        options.batch_s,
        "Seconds that a task should take: 90 on a farm of your own, 300 to 600 on a shared one")
        ->check(CLI::Range(1.0, 86400.0));
    add("--slurm-argument", slurm.arguments, "One more argument for sbatch; may be given again");
    add("--slurm-bakerd", options.task_program, "bakerd on the nodes; default: the path of this one")
        ->check(CLI::ExistingFile);
    command
        .add_flag("--slurm-resume-nodes",
                  slurm.resumes_nodes,
                  "Resume nodes that Slurm drained for a \"Duplicate jobid\": only on a farm of your own, "
                  "as Slurm's operator")
        ->group("With --executor slurm");
}

}  // namespace

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
    if (options.is_on_slurm()) {
        if (options.store.empty())
            return cli::fail(cli::exit_usage, "--executor slurm needs --store, a folder that all nodes see");
        if (const auto found = executor::run_command({"sbatch", "--version"}, std::chrono::seconds(20));
            !found)
            return cli::fail(cli::exit_unreadable,
                             fmt::format("--executor slurm needs Slurm's commands: {}", found.error()));
    }
    farm::Farm::Options farm_options;
    farm_options.data_folder = options.data;
    // A task starts elsewhere: a relative path would mean another folder.
    if (!options.store.empty())
        farm_options.store_folder = std::filesystem::absolute(options.store).lexically_normal().string();
    farm_options.cache_bytes = options.cache_bytes;
    farm_options.executor =
        executor_options(options, farm_options.store_folder, farm_options.blob_folder(), threads);
    auto farm = farm::Farm::open(std::move(farm_options));
    if (!farm)
        return cli::fail(cli::exit_unreadable, farm.error().message);
    auto server = service::Server::start(
        **farm, options.listen, options.tls, {std::string(trace::isa_class()), bake::baker_version});
    if (!server)
        return cli::fail(cli::exit_unreadable, server.error());
    spdlog::info("bakerd listens on {}, keeps its data in {}, bakes {}",
                 (*server)->address(),
                 options.data,
                 options.is_on_slurm() ? "on Slurm" : fmt::format("on {} threads", threads));

    int signal = 0;
    sigwait(&signals, &signal);
    spdlog::info("stopping: {}",
                 options.is_on_slurm() ? "tasks on the cluster go on"
                                       : "the running sectors are finished or put back");
    // The farm first: calls that wait for it get their answer, and the server need not wait for them.
    (*farm)->stop(std::chrono::seconds(10));
    (*server)->stop();
    spdlog::info("stopped");
    return cli::exit_done;
}

void add_serve(CLI::App& app, ServeOptions& options, std::function<void()> chosen) {
    CLI::App* serve_command = app.add_subcommand("serve", "Serve clients until SIGTERM or ctrl-C");
    serve_command
        ->add_option("--data", options.data, "Local folder for the database, and blobs; made when missing")
        ->required();
    serve_command->add_option(
        "--store",
        options.store,
        "Folder for blobs, which may be on a network; default: within --data. Needed for --executor slurm");
    serve_command
        ->add_option("--listen", options.listen, "Address and port; anything but loopback should have TLS")
        ->capture_default_str();
    serve_command->add_option("--executor", options.executor, "Where sectors are baked")
        ->check(cli::one_of({"local", "slurm"}))
        ->capture_default_str();
    add_slurm(*serve_command, options);
    serve_command
        ->add_option("--threads",
                     options.threads,
                     "Threads to bake with, or for --executor slurm to answer questions with; 0: all")
        ->check(cli::whole_number(0, 1024))
        ->capture_default_str();
    serve_command
        ->add_option(
            "--worker-memory",
            options.worker_memory_bytes,
            "Bytes that baking on this machine may take, as 8GB; a map that needs more fails; 0: no limit")
        ->transform(CLI::AsSizeValue(true))
        ->check(worker_memory_check())
        ->capture_default_str();
    serve_command
        ->add_option("--worker-nice",
                     options.worker_nice,
                     "How far other programs of this machine go before baking: 0 (not at all) to 19")
        ->check(cli::whole_number(0, 19))
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
    serve_command->callback(std::move(chosen));
}

}  // namespace drtv
