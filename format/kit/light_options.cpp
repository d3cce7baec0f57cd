#include "light_options.h"

#include "cli/option_checks.h"

namespace drtv::kit {

void add_light(CLI::App& command, LightRequest& light) {
    CLI::Option* time =
        command.add_option("--time", light.time, "Sun, sky and light groups at this time of a day")
            ->type_name("HH:MM");
    command
        .add_option("--gradients", light.gradients, "The day (light.schema.json) instead of the built-in one")
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
        ->check(cli::one_of({"literal", "accurate"}))
        ->capture_default_str();
}

}  // namespace drtv::kit
