// bakerd: parse, wire, run.
#include "bakerd/doctor.h"
#include "bakerd/picture/render_request.h"
#include "bakerd/serve.h"
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

#include <cstdlib>
#include <functional>

namespace drtv {
namespace {

// What the command line says.
struct Arguments {
    ServeOptions serve;
    worker::Options worker;
    worker::BatchOptions batch;
    picture::RenderRequest render;
    DoctorOptions doctor;
    // The command. Set when the line has been parsed.
    std::function<cli::Result<cli::ExitCode>()> run;
};

void add_worker(CLI::App& app, Arguments& to) {
    CLI::App* command =
        app.add_subcommand("worker", "Answer requests on standard input (started by the daemon)");
    command->add_option("--blobs", to.worker.blob_folder, "Folder of the blob store")->required();
    command->add_option("--threads", to.worker.threads, "Threads to bake with; 0: all")
        ->check(cli::whole_number(0, 1024));
    command->add_option("--memory", to.worker.memory_bytes, "Bytes it may take; 0: no limit");
    command->add_option("--nice", to.worker.nice, "How far other programs go before")
        ->check(cli::whole_number(0, 19));
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
    command->add_option(
        "--logs", batch.logs, "Folder within the store that standard error goes to, for people");
    command->callback([&to] {
        to.run = [&to]() -> cli::Result<cli::ExitCode> {
            if (auto ran = worker::run_batch(to.batch); !ran)
                return cli::fail(ran.error().differs ? cli::exit_differs : cli::exit_unreadable,
                                 ran.error().sentence);
            return cli::exit_done;
        };
    });
}

void add_doctor(CLI::App& app, Arguments& to) {
    CLI::App* command = app.add_subcommand("doctor", "Say what a node of a cluster lacks to bake");
    command->add_option("--store", to.doctor.store, "The daemon's --store")->required();
    command->add_option("--slurm-partition", to.doctor.partition, "The daemon's --slurm-partition");
    command->callback([&to] { to.run = [&to] { return examine_node(to.doctor); }; });
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
    add_serve(app, arguments.serve, [&arguments] {
        arguments.run = [&arguments] { return serve(arguments.serve); };
    });
    add_worker(app, arguments);
    add_task(app, arguments);
    add_render(app, arguments);
    add_doctor(app, arguments);
    if (const auto ended = cli::parse(app, argc, argv))
        return *ended;
    return cli::end_program(arguments.run());
}
