// bake: parse, connect, run.
#include "client/command_cache.h"
#include "client/command_list.h"
#include "client/command_logs.h"
#include "client/command_plan.h"
#include "client/command_pull.h"
#include "client/command_report.h"
#include "client/command_submit.h"
#include "client/command_watch.h"
#include "client/number_text.h"
#include "client/server_file.h"
#include "format/cli/option_checks.h"
#include "format/cli/parse.h"
#include "format/cli/report.h"
#include "format/cli/version.h"
#include "settings/table.h"

#include <malloc.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>

namespace drtv::client {
namespace {

// What the command line says.
struct Arguments {
    ConnectionOptions connection;
    SubmitOptions submit;
    PlanPicture picture;
    std::string job;
    std::string sector;  // "I,J"
    std::string folder;
    bool clear = false;
    bool mine = false;
    bool warnings_as_errors = false;
    // The subcommand. Set when the line has been parsed.
    std::function<cli::Result<cli::ExitCode>(ServerConnection&)> run;
};

using Command = std::function<cli::Result<cli::ExitCode>(ServerConnection&)>;

// Runs the command, once the server is known to be there.
void when_called(CLI::App& command, Arguments& to, Command run) {
    command.callback([&to, run = std::move(run)] {
        to.run = [&to, run](ServerConnection& connection) -> cli::Result<cli::ExitCode> {
            limit_time(to.submit.timeout_s);
            if (auto checked = check_server(connection); !checked)
                return tl::unexpected(checked.error());
            return run(connection);
        };
    });
}

void add_connection_options(CLI::App& app, ConnectionOptions& options) {
    app.add_option("--server",
                   options.server,
                   "bakerd's HOST:PORT, or its name in the file below; default 127.0.0.1:7447")
        ->envname("DRTV_SERVER");
    app.add_flag("--json", options.json, "Print JSON, one object per line (bake.schema.json)");
    app.add_option("--tls-ca", options.tls_ca, "Authority that signs the server's certificate (PEM)")
        ->envname("DRTV_TLS_CA");
    app.add_option("--tls-cert", options.tls_certificate, "This client's certificate (PEM)")
        ->envname("DRTV_TLS_CERT");
    app.add_option("--tls-key", options.tls_key, "Its key (PEM)")->envname("DRTV_TLS_KEY");
}

void add_timeout(CLI::App& command, SubmitOptions& submit) {
    command
        .add_option("--timeout",
                    submit.timeout_s,
                    "Seconds to wait for the job's end; then the exit status is 8, and the job goes on")
        ->check(cli::number_below(1e8));
}

void add_map_options(CLI::App& command, SubmitOptions& submit) {
    command.add_option("MAP", submit.maps, "glTF files (.gltf, .glb), or folders of them")->required();
    command.add_option("--region", submit.region, "X0,Y0,X1,Y1 in world metres: only the sectors it touches");
    command
        .add_option(
            "--preset", submit.preset, "draft (few rays), console, or pc (with local radiance transfer)")
        ->capture_default_str();
    command
        .add_option(
            "--set", submit.settings, "Changes one setting of the preset, any number of times; listed below")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command.footer(settings::help_text());
    command.add_flag("--exact", submit.exact, "Bake whatever could differ in one bit: tolerance=0");
}

void add_map_commands(CLI::App& app, Arguments& to) {
    CLI::App* submit = app.add_subcommand("submit", "Upload a map and bake it");
    CLI::App* plan = app.add_subcommand("plan", "Say what would be baked, and why, without baking");
    add_map_options(*submit, to.submit);
    add_map_options(*plan, to.submit);
    CLI::Option* png = plan->add_option("--png", to.picture.path, "Draw the plan from above to this file")
                           ->type_name("FILE.png");
    plan->add_option("--under",
                     to.picture.under,
                     "With --png: a picture to lie under the plan: what bakerd render --top makes")
        ->needs(png)
        ->type_name("FILE.png");
    submit
        ->add_option("--priority",
                     to.submit.priority,
                     "interactive: somebody waits; nightly: after all that are interactive")
        ->check(cli::one_of({"interactive", "nightly"}))
        ->capture_default_str();
    submit->add_option("--label", to.submit.label, "What you call the job; shown where jobs are listed");
    submit->add_flag("--yes", to.submit.yes, "Bake more than 2,500 sectors without a question");
    submit->add_flag("--wait", to.submit.wait, "Show progress until the job ends");
    submit->add_option("--pull", to.submit.pull_folder, "Wait, then write the sector files to this folder");
    submit->add_flag(
        "--replace", to.submit.replace, "With --pull: take a folder that holds sectors of another map");
    add_timeout(*submit, to.submit);
    submit->callback([&to] {
        if (to.submit.timeout_s > 0 && !to.submit.wait && to.submit.pull_folder.empty())
            throw CLI::ValidationError("--timeout", "goes with --wait or --pull");
        to.run = [&to](ServerConnection& connection) { return run_submit(connection, to.submit); };
    });
    plan->callback([&to] {
        to.run = [&to](ServerConnection& connection) { return run_plan(connection, to.submit, to.picture); };
    });
}

// "12", or the resource's name.
CLI::Validator job_number_check() {
    return {[](std::string& text) {
                const std::string number = text.starts_with("jobs/") ? text.substr(5) : text;
                const bool is_number = !number.empty() && number.size() < 19 &&
                                       number.find_first_not_of("0123456789") == std::string::npos;
                return is_number ? "" : "\"" + text + "\" is no number of a job";
            },
            ""};
}

void add_job_commands(CLI::App& app, Arguments& to) {
    CLI::App* list = app.add_subcommand("list", "All jobs, newest first");
    CLI::App* status = app.add_subcommand("status", "One job, now");
    CLI::App* watch = app.add_subcommand("watch", "Show a job's progress until it ends");
    CLI::App* wait = app.add_subcommand("wait", "Wait for a job's end, and say no more than that");
    CLI::App* cancel = app.add_subcommand("cancel", "Stop a job; what is done stays");
    CLI::App* raise = app.add_subcommand("raise", "Bake a job before all others of its owner");
    CLI::App* hold = app.add_subcommand("hold", "Begin no more sectors of a job");
    CLI::App* release = app.add_subcommand("release", "Go on with a job that is held");
    CLI::App* report = app.add_subcommand(
        "report", "A job in numbers: time by stage, probes dropped, error reached, warnings by object");
    CLI::App* retry = app.add_subcommand("retry", "Bake the sectors again that have failed");
    CLI::App* pull = app.add_subcommand("pull", "Write a job's finished sector files to a folder");
    CLI::App* logs = app.add_subcommand("logs", "What a cluster's task printed while it baked a sector");
    for (CLI::App* command : {status, watch, wait, report, cancel, raise, hold, release, retry, pull, logs})
        command->add_option("JOB", to.job, "Number of the job")->required()->check(job_number_check());
    for (CLI::App* command : {watch, wait})
        add_timeout(*command, to.submit);
    pull->add_option("--out", to.folder, "Folder for the files; made when missing")->required();
    pull->add_flag("--replace", to.submit.replace, "Take a folder that holds sectors of another map");
    logs->add_option("SECTOR", to.sector, "The sector, as I,J")->required();
    list->add_flag("--mine", to.mine, "Only yours: of your certificate, or of your user name");
    when_called(*list, to, [&to](ServerConnection& connection) { return run_list(connection, to.mine); });
    when_called(*status, to, [&to](ServerConnection& connection) { return run_status(connection, to.job); });
    when_called(
        *watch, to, [&to](ServerConnection& connection) { return run_watch(connection, to.job, {}); });
    when_called(*wait, to, [&to](ServerConnection& connection) {
        return run_watch(connection, to.job, {.quiet = true});
    });
    when_called(*report, to, [&to](ServerConnection& connection) { return run_report(connection, to.job); });
    when_called(
        *logs, to, [&to](ServerConnection& connection) { return run_logs(connection, to.job, to.sector); });
    when_called(*raise, to, [&to](ServerConnection& connection) { return run_raise(connection, to.job); });
    when_called(*hold, to, [&to](ServerConnection& connection) { return run_hold(connection, to.job); });
    when_called(
        *release, to, [&to](ServerConnection& connection) { return run_release(connection, to.job); });
    when_called(*retry, to, [&to](ServerConnection& connection) { return run_retry(connection, to.job); });
    when_called(*cancel, to, [&to](ServerConnection& connection) { return run_cancel(connection, to.job); });
    when_called(*pull, to, [&to](ServerConnection& connection) {
        return run_pull(connection, to.job, to.folder, to.submit.replace);
    });
}

void add_cache_command(CLI::App& app, Arguments& to) {
    CLI::App* cache = app.add_subcommand("cache", "Size and hit rate of the results that bakerd keeps");
    cache->add_flag("--clear", to.clear, "Remove all that no running job needs");
    when_called(*cache, to, [&to](ServerConnection& connection) { return run_cache(connection, to.clear); });
}

}  // namespace
}  // namespace drtv::client

int main(int argc, char** argv) {
    using namespace drtv;
    // gRPC tells failures in paragraphs of its own; ours are one sentence. The variable, when set, wins.
    ::setenv("GRPC_VERBOSITY", "NONE", 0);
    // Arrived files come and go: pages given back at once, and faulted in anew, were 40 % of a pull's CPU
    // time.
    ::mallopt(M_TRIM_THRESHOLD, 64 << 20);
    ::mallopt(M_TOP_PAD, 1 << 20);
    CLI::App app{"bake submits maps to bakerd and pulls the baked sector files.", "bake"};
    app.require_subcommand(1);
    app.set_version_flag("--version", cli::version_text("bake"));
    app.footer("bake COMMAND --help lists a command's options. Servers have names in " +
               client::server_file_path() + " (docs/client.md).\n\n" + cli::exit_code_help("bake"));
    client::Arguments arguments;
    client::add_connection_options(app, arguments.connection);
    app.add_flag("--warnings-as-errors",
                 arguments.warnings_as_errors,
                 "End with exit status 3 where there was a warning and nothing worse");
    client::add_map_commands(app, arguments);
    client::add_job_commands(app, arguments);
    client::add_cache_command(app, arguments);
    for (CLI::App* command : app.get_subcommands({}))
        command->fallthrough();
    if (const auto ended = cli::parse(app, argc, argv))
        return *ended;
    auto connection = client::connect(arguments.connection);
    if (!connection)
        return cli::complain(connection.error());
    // A line is out as soon as it is whole, however the program ends.
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    auto ended = arguments.run(*connection);
    const std::size_t warnings = cli::warnings_told().size();
    if (ended && *ended == cli::exit_done && arguments.warnings_as_errors && warnings > 0)
        ended = cli::fail(cli::exit_invalid,
                          client::counted(static_cast<std::int64_t>(warnings), "warning", "warnings") +
                              ", which --warnings-as-errors makes errors");
    return cli::end_program(ended);
}
