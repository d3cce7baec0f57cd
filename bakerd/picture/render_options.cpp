#include "bakerd/picture/render_request.h"
#include "bakerd/picture/show.h"

#include "format/cli/option_checks.h"
#include "format/kit/light_options.h"

#include <CLI/CLI.hpp>

namespace drtv::picture {
namespace {

std::vector<std::string> names_of_shows() {
    std::vector<std::string> names;
    for (const ShowName& show : show_names())
        names.emplace_back(show.name);
    return names;
}

void add_view(CLI::App& command, RenderRequest& request) {
    command.add_option("--size", request.size, "Pixels")->type_name("WxH")->capture_default_str();
    CLI::Option* camera =
        command.add_option("--camera", request.camera, "Its place, in metres; without it, a view by rule")
            ->type_name("x,y,z");
    CLI::Option* look =
        command.add_option("--look", request.look, "A place that it looks at")->type_name("x,y,z");
    camera->needs(look);
    look->needs(camera);
    CLI::Option* fov =
        command.add_option("--fov", request.fov_deg, "Degrees from the left side to the right")
            ->check(cli::number_between(1, 170))
            ->capture_default_str();
    CLI::Option* top = command.add_flag(
        "--top", request.top, "The map from above; the PNG says of which part of the world it is");
    top->excludes(camera)->excludes(fov);
    command
        .add_option("--region",
                    request.region,
                    "Of the world, from above; by default all sectors. Widened to the picture's shape")
        ->needs(top)
        ->type_name("X0,Y0,X1,Y1");
}

void add_picture(CLI::App& command, RenderRequest& request) {
    command.add_option("--show", request.show, "What is shown: " + cli::joined(names_of_shows()))
        ->check(cli::one_of(names_of_shows()))
        ->type_name("WHAT")
        ->capture_default_str();
    command
        .add_option(
            "--by", request.by, "Which probes: nearest, trilinear, volume; from above trilinear, else volume")
        ->check(cli::one_of({"nearest", "trilinear", "volume"}));
    command
        .add_option(
            "--encoding",
            request.encoding,
            "Of the volume's texels: rgba8, rgba8-sqrt, rgba16f; rgba16f, but to show what is clipped")
        ->check(cli::one_of({"rgba8", "rgba8-sqrt", "rgba16f"}));
    command.add_flag_callback(
        "--no-interiors", [&request] { request.interiors = false; }, "Places inside are lit as outside");
    command
        .add_option("--exposure",
                    request.exposure,
                    "noon: one for all pictures, so that night is night; auto: each its own; or stops (EV), "
                    "-128 to 128")
        ->capture_default_str();
    command.add_option("--pick", request.picks, "Print what is at a pixel, as JSON; any number of times")
        ->allow_extra_args(false)
        ->type_name("x,y");
    CLI::Option* compare = command.add_flag(
        "--compare", request.compare, "Beside path tracing, with errors by part; takes minutes");
    command.add_option("--paths", request.paths, "Of the path tracer, a pixel")
        ->check(cli::whole_number(16, 65536))
        ->needs(compare)
        ->capture_default_str();
}

}  // namespace

void add_render(CLI::App& command, RenderRequest& request) {
    command.footer("Without any light it is noon; what is not said of light is dark.\n\n" +
                   cli::exit_code_help("bakerd"));
    command.add_option("DIR", request.folder, "A folder of sector files, or one; before --map")->required();
    command.add_option("--map", request.maps, "glTF files that they were baked of, or folders of these")
        ->required()
        ->type_name("MAP");
    command.add_option("--out", request.out, "The picture")->type_name("FILE.png");
    add_view(command, request);
    add_picture(command, request);
    kit::add_light(command, request.light);
    command.add_option("--times", request.times, "A sheet of pictures over the day: 06:00,12:00")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->excludes(command.get_option("--time"))
        ->excludes(command.get_option("--sun-direction"))
        ->excludes(command.get_option("--sky"))
        ->excludes(command.get_option("--sky-colours"))
        ->excludes(command.get_option("--compare"))
        ->type_name("HH:MM,...");
    command.add_option("--threads", request.threads, "0: all")
        ->check(cli::whole_number(0, 1024))
        ->capture_default_str();
}

}  // namespace drtv::picture
