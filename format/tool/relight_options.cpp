#include "relight_options.h"

#include "option_checks.h"

namespace drtv::tool {

void add_light(CLI::App& command, LightRequest& light) {
    CLI::Option* time =
        command.add_option("--time", light.time, "Sun, sky and light groups at this time of a day")
            ->type_name("HH:MM");
    command
        .add_option("--gradients", light.gradients, "The day (light.schema.json) instead of the built-in one")
        ->needs(time)
        ->type_name("FILE.json");
    CLI::Option* direction =
        command.add_option("--sun-direction", light.sun_direction, "Towards the sun, any length")
            ->excludes(time)
            ->type_name("x,y,z");
    command.add_option("--sun", light.sun, "Irradiance from the sun on a surface that faces it")
        ->excludes(time)
        ->needs(direction)
        ->type_name("r,g,b");
    CLI::Option* sky =
        command.add_option("--sky", light.sky, "A sky of one radiance")->excludes(time)->type_name("r,g,b");
    command
        .add_option("--sky-colours", light.sky_colours, "Radiance at zenith, horizon and on the sun's side")
        ->excludes(time)
        ->excludes(sky)
        ->type_name("NINE,NUMBERS");
    command
        .add_option("--light", light.lights, "A lamp: its place, and its flux / (4 pi); any number of times")
        ->allow_extra_args(false)
        ->type_name("x,y,z,r,g,b");
    command.add_option("--group", light.groups, "Factor of a light group; any number of times")
        ->allow_extra_args(false)
        ->type_name("NAME=r,g,b");
    command.add_option("--mode", light.mode, "accurate, or literal: the talk's code")
        ->check(one_of({"literal", "accurate"}))
        ->capture_default_str();
}

void add_relight(CLI::App& app, RelightRequest& request, std::function<int()>& run) {
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
        ->check(one_of({"nearest", "trilinear", "volume"}))
        ->capture_default_str();
    CLI::Option* camera =
        relight
            ->add_option("--camera", request.camera, "Of the volume's window; by default each place itself")
            ->type_name("x,y,z");
    CLI::Option* encoding =
        relight
            ->add_option("--encoding", request.encoding, "Of the volume's texels: rgba8, rgba8-sqrt, rgba16f")
            ->check(one_of({"rgba8", "rgba8-sqrt", "rgba16f"}))
            ->capture_default_str();
    relight
        ->add_option(
            "--offset",
            request.offset_m,
            "Metres along the normal at which probes and interiors are asked (0; with --by volume 1)")
        ->check(finite_number());
    relight->add_flag_callback(
        "--no-interiors",
        [&request] { request.interiors = false; },
        "Places inside are lit as outside; lamps still know interiors");
    relight->add_flag("--json", request.json, "Print JSON, one object per place");
    add_light(*relight, request.light);
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
