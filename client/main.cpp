// bake: parse, connect, run.
#include "client/command_cache.h"
#include "client/command_list.h"
#include "client/command_plan.h"
#include "client/command_pull.h"
#include "client/command_submit.h"
#include "client/command_watch.h"

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <functional>
#include <string>

namespace drtv::client {
namespace {

// What the command line says.
struct Arguments {
    ConnectionOptions connection;
    SubmitOptions submit;
    std::string picture;
    std::string job;
    std::string folder;
    bool clear = false;
    // The subcommand. Set when the line has been parsed.
    std::function<int(Connection&)> run;
};

void add_connection_options(CLI::App& app, ConnectionOptions& options) {
    app.add_option("--server", options.server, "Address of bakerd")
        ->envname("DRTV_SERVER")
        ->capture_default_str();
    app.add_flag("--json", options.json, "Print JSON, one object a line");
    app.add_option("--tls-ca", options.tls_ca, "Authority that signs the server's certificate (PEM)");
    app.add_option("--tls-cert", options.tls_certificate, "This client's certificate (PEM)");
    app.add_option("--tls-key", options.tls_key, "Its key (PEM)");
}

void add_map_options(CLI::App& command, SubmitOptions& submit) {
    command.add_option("MAP", submit.maps, "glTF files (.gltf, .glb), or folders of them")->required();
    command.add_option("--region", submit.region, "X0,Y0,X1,Y1 in world metres: only the sectors it touches");
    command.add_option("--preset", submit.preset, "draft, console or pc")->capture_default_str();
    command
        .add_option("--set",
                    submit.settings,
                    "key=value: rays, bounces, reach (m), min_distance (m), error, tolerance, lprt, "
                    "lprt_bounces, lprt_rays")
        ->allow_extra_args(false);
    command.add_flag("--exact", submit.exact, "Bake whatever could differ in one bit: tolerance=0");
}

void add_map_commands(CLI::App& app, Arguments& to) {
    CLI::App* submit = app.add_subcommand("submit", "Upload a map and bake it");
    CLI::App* plan = app.add_subcommand("plan", "Say what would be baked, and why, without baking");
    add_map_options(*submit, to.submit);
    add_map_options(*plan, to.submit);
    plan->add_option("--png", to.picture, "Draw the plan from above to this file");
    submit->add_flag("--wait", to.submit.wait, "Show progress until the job ends");
    submit->add_option("--pull", to.submit.pull_folder, "Wait, then write the sector files to this folder");
    submit->callback(
        [&to] { to.run = [&to](Connection& connection) { return run_submit(connection, to.submit); }; });
    plan->callback([&to] {
        to.run = [&to](Connection& connection) { return run_plan(connection, to.submit, to.picture); };
    });
}

void add_job_commands(CLI::App& app, Arguments& to) {
    CLI::App* list = app.add_subcommand("list", "All jobs, newest first");
    CLI::App* status = app.add_subcommand("status", "One job, now");
    CLI::App* watch = app.add_subcommand("watch", "Show a job's progress until it ends");
    CLI::App* cancel = app.add_subcommand("cancel", "Stop a job; what is done stays");
    CLI::App* pull = app.add_subcommand("pull", "Write a job's finished sector files to a folder");
    for (CLI::App* command : {status, watch, cancel, pull})
        command->add_option("JOB", to.job, "Number of the job")->required();
    pull->add_option("--out", to.folder, "Folder for the files; made when missing")->required();
    list->callback([&to] { to.run = run_list; });
    status->callback(
        [&to] { to.run = [&to](Connection& connection) { return run_status(connection, to.job); }; });
    watch->callback(
        [&to] { to.run = [&to](Connection& connection) { return run_watch(connection, to.job); }; });
    cancel->callback(
        [&to] { to.run = [&to](Connection& connection) { return run_cancel(connection, to.job); }; });
    pull->callback([&to] {
        to.run = [&to](Connection& connection) { return run_pull(connection, to.job, to.folder); };
    });
}

void add_cache_command(CLI::App& app, Arguments& to) {
    CLI::App* cache = app.add_subcommand("cache", "Size and hit rate of the results that bakerd keeps");
    cache->add_flag("--clear", to.clear, "Remove all that no running job needs");
    cache->callback(
        [&to] { to.run = [&to](Connection& connection) { return run_cache(connection, to.clear); }; });
}

// Gives the exit status.
int end_parse(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0)
        return app.exit(error);  // --help, --version
    const bool unknown_command = app.get_subcommands().empty() && !app.remaining().empty();
    const std::string what =
        unknown_command ? "there is no command '" + app.remaining().front() + "'" : error.what();
    complain(what + "; bake --help lists what there is");
    return 2;
}

}  // namespace
}  // namespace drtv::client

int main(int argc, char** argv) {
    using namespace drtv::client;
    // gRPC tells failures in paragraphs of its own; ours are one sentence. The variable, when set, wins.
    ::setenv("GRPC_VERBOSITY", "NONE", 0);
    CLI::App app{"bake submits maps to bakerd and pulls the baked sector files."};
    app.require_subcommand(1);
    app.set_version_flag("--version", "bake " DRTV_VERSION);
    Arguments arguments;
    add_connection_options(app, arguments.connection);
    add_map_commands(app, arguments);
    add_job_commands(app, arguments);
    add_cache_command(app, arguments);
    for (CLI::App* command : app.get_subcommands({}))
        command->fallthrough();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return end_parse(app, error);
    }
    auto connection = connect(arguments.connection);
    if (!connection)
        return complain(connection.error());
    return arguments.run(*connection);
}
