#include "relight_options.h"

#include "cli/option_checks.h"
#include "kit/light_options.h"

namespace drtv::tool {

void add_relight(CLI::App& app, RelightRequest& request, std::function<cli::Result<cli::ExitCode>()>& run) {
    CLI::App* relight = app.add_subcommand("relight", "The ambient light at places, as a game gets it");
    relight->add_option("DIR", request.folder, "A folder of sector files, or one file")->required();
    CLI::Option* at = relight->add_option("--at", request.at, "A place, in metres")->type_name("x,y,z");
    CLI::Option* normal =
        relight->add_option("--normal", request.normal, "The normal there, any length")->type_name("x,y,z");
    CLI::Option* points =
        relight
            ->add_option("--points",
                         request.points,
                         "Many: {\"at\":[x,y,z],\"normal\":[x,y,z]} per line; - is standard input")
            ->type_name("FILE");
    at->needs(normal)->excludes(points);
    normal->needs(at);
    relight->add_option("--by", request.by, "Which probes: nearest, trilinear, volume")
        ->check(cli::one_of({"nearest", "trilinear", "volume"}))
        ->capture_default_str();
    CLI::Option* camera =
        relight
            ->add_option("--camera", request.camera, "Of the volume's window; by default each place itself")
            ->type_name("x,y,z");
    CLI::Option* encoding =
        relight
            ->add_option("--encoding", request.encoding, "Of the volume's texels: rgba8, rgba8-sqrt, rgba16f")
            ->check(cli::one_of({"rgba8", "rgba8-sqrt", "rgba16f"}))
            ->capture_default_str();
    relight
        ->add_option(
            "--offset",
            request.offset_m,
            "Metres along the normal at which probes and interiors are asked (0; with --by volume 1)")
        ->check(cli::finite_number());
    relight->add_flag_callback(
        "--no-interiors",
        [&request] { request.interiors = false; },
        "Places inside are lit as outside; lamps still know interiors");
    relight->add_flag("--json", request.json, "Print JSON, one object per place");
    kit::add_light(*relight, request.light);
    relight->callback([&request, &run, at, points, camera, encoding] {
        for (const CLI::Option* option : {camera, encoding}) {
            if (option->count() > 0 && request.by != "volume")
                throw CLI::ValidationError(option->get_name(), "goes with --by volume");
        }
        if (at->count() == 0 && points->count() == 0)
            throw CLI::RequiredError("--at with --normal, or --points,");
        run = [&request] { return run_relight(request); };
    });
}

}  // namespace drtv::tool
