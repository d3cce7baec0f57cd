// bake: parse, connect, run.
#include "client/commands.h"

#include <CLI/CLI.hpp>

#include <cstdlib>

int main(int argc, char** argv) {
    using namespace drtv::client;
    // gRPC tells failures in paragraphs of its own; ours are one sentence. The variable, when set, wins.
    ::setenv("GRPC_VERBOSITY", "NONE", 0);
    CLI::App app{"bake submits maps to bakerd and pulls the baked sector files."};
    app.require_subcommand(1);
    app.set_version_flag("--version", "bake 0.1.0");

    ConnectionOptions options;
    app.add_option("--server", options.server, "Address of bakerd")
        ->envname("DRTV_SERVER")
        ->capture_default_str();
    app.add_flag("--json", options.json, "Print JSON, one object a line");
    app.add_option("--tls-ca", options.tls_ca, "Authority that signs the server's certificate (PEM)");
    app.add_option("--tls-cert", options.tls_certificate, "This client's certificate (PEM)");
    app.add_option("--tls-key", options.tls_key, "Its key (PEM)");

    SubmitOptions submit;
    CLI::App* submit_command = app.add_subcommand("submit", "Upload a map and bake it");
    std::string picture;
    CLI::App* plan_command = app.add_subcommand("plan", "Say what would be baked, and why, without baking");
    for (CLI::App* command : {submit_command, plan_command}) {
        command->add_option("MAP", submit.maps, "glTF files (.gltf, .glb), or folders of them")->required();
        command->add_option(
            "--region", submit.region, "X0,Y0,X1,Y1 in world metres: only the sectors it touches");
        command->add_option("--preset", submit.preset, "draft, console or pc")->capture_default_str();
        command
            ->add_option("--set",
                         submit.settings,
                         "key=value: rays, bounces, reach (m), min_distance (m), error, tolerance, lprt, "
                         "lprt_bounces, lprt_rays")
            ->allow_extra_args(false);
        command->add_flag("--exact", submit.exact, "Bake whatever could differ in one bit: tolerance=0");
    }
    plan_command->add_option("--png", picture, "Draw the plan from above to this file");
    submit_command->add_flag("--wait", submit.wait, "Show progress until the job ends");
    submit_command->add_option(
        "--pull", submit.pull_folder, "Wait, then write the sector files to this folder");

    std::string job, folder;
    app.add_subcommand("list", "All jobs, newest first");
    CLI::App* status_command = app.add_subcommand("status", "One job, now");
    CLI::App* watch_command = app.add_subcommand("watch", "Show a job's progress until it ends");
    CLI::App* cancel_command = app.add_subcommand("cancel", "Stop a job; what is done stays");
    CLI::App* pull_command = app.add_subcommand("pull", "Write a job's finished sector files to a folder");
    bool clear = false;
    CLI::App* cache_command =
        app.add_subcommand("cache", "Size and hit rate of the results that bakerd keeps");
    cache_command->add_flag("--clear", clear, "Remove all that no running job needs");
    for (CLI::App* command : {status_command, watch_command, cancel_command, pull_command})
        command->add_option("JOB", job, "Number of the job")->required();
    pull_command->add_option("--out", folder, "Folder for the files; made when missing")->required();
    for (CLI::App* command : app.get_subcommands({}))
        command->fallthrough();

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0)
            return app.exit(error);  // --help, --version
        const std::string what = app.get_subcommands().empty() && !app.remaining().empty()
                                     ? "there is no command '" + app.remaining().front() + "'"
                                     : error.what();
        complain(what + "; bake --help lists what there is");
        return 2;
    }
    auto connection = connect(options);
    if (!connection)
        return complain(connection.error());
    if (*submit_command)
        return run_submit(*connection, submit);
    if (*plan_command)
        return run_plan(*connection, submit, picture);
    if (*cache_command)
        return run_cache(*connection, clear);
    if (*status_command)
        return run_status(*connection, job);
    if (*watch_command)
        return run_watch(*connection, job);
    if (*cancel_command)
        return run_cancel(*connection, job);
    if (*pull_command)
        return run_pull(*connection, job, folder);
    return run_list(*connection);
}
