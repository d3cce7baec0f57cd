// drtv: validates, shows, compares, strips, pictures and relights sector files. Here the command line is
// taken apart.
#include "command_relight.h"
#include "commands.h"

#include <drtv/version.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace drtv::tool {

void complain(const std::string& sentence) {
    std::fprintf(stderr, "drtv: %s\n", sentence.c_str());
}

namespace {

constexpr double max_metres_per_pixel = 1000;

// What the command line says.
struct CommandLine {
    ValidateRequest validate;
    PreviewRequest preview{{}, {}, 0, "relit"};
    StripRequest strip;
    DiffRequest diff;
    RelightRequest relight;
    std::string file;  // of info and dump
    // Said for the reader of a script; there is no other way yet.
    bool full = false;
    bool dump_json = false;
    // The command. Set when the line has been parsed.
    std::function<int()> run;
};

std::string joined(const std::vector<std::string>& words) {
    return CLI::detail::join(words, ", ");
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto check = [words](const std::string& word) {
        const bool known = std::ranges::find(words, word) != words.end();
        return known ? std::string() : "takes one of " + joined(words) + ", not \"" + word + "\"";
    };
    return {check, ""};
}

CLI::Validator whole_number(std::size_t min, std::size_t max) {
    const auto check = [=](const std::string& text) {
        std::size_t number = 0;
        if (CLI::detail::lexical_cast(text, number) && number >= min && number <= max)
            return std::string();
        return "takes a number from " + std::to_string(min) + " to " + std::to_string(max) + ", not \"" +
               text + "\"";
    };
    return {check, ""};
}

// Infinity and what is no number are refused too.
CLI::Validator metres_per_pixel() {
    const auto check = [](const std::string& text) {
        double number = 0;
        if (CLI::detail::lexical_cast(text, number) && number > 0 && number < max_metres_per_pixel)
            return std::string();
        return "takes a number between 0 and 1000, not \"" + text + "\"";
    };
    return {check, ""};
}

CLI::Validator finite_number() {
    const auto check = [](const std::string& text) {
        double number = 0;
        if (CLI::detail::lexical_cast(text, number) && std::isfinite(number))
            return std::string();
        return "takes a number, not \"" + text + "\"";
    };
    return {check, ""};
}

void add_checks(CLI::App& app, CommandLine& line) {
    CLI::App* validate = app.add_subcommand("validate", "Check sector files, or all of a folder");
    ValidateRequest& request = line.validate;
    validate->add_option("PATH", request.paths, "Files or folders")->required();
    validate->add_flag("--json", request.json, "Print JSON, one object per line (report.schema.json)");
    CLI::Option* quick =
        validate->add_flag("--quick", request.quick, "Structure and checksums only: what a reader checks");
    validate->add_flag("--full", line.full, "Everything: the default")->excludes(quick);
    validate->add_flag("--neighbours", request.neighbours, "Also the sectors of a folder against each other")
        ->excludes(quick);
    validate->add_flag(
        "--warnings-as-errors", request.warnings_as_errors, "A file with a warning is invalid too");
    validate
        ->add_option("--ignore", request.ignored, "Leave out findings of this code; drtv issues lists them")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("CODE");
    validate->add_option("--max-findings", request.max_findings, "Findings shown per file")
        ->check(whole_number(1, 1'000'000))
        ->capture_default_str();
    validate->callback([&line] { line.run = [&line] { return run_validate(line.validate); }; });

    CLI::App* issues = app.add_subcommand("issues", "The table of all that validate can find");
    issues->callback([&line] { line.run = run_issues; });
}

void add_views(CLI::App& app, CommandLine& line) {
    CLI::App* info = app.add_subcommand("info", "What a sector file holds");
    info->add_option("FILE", line.file, "A sector file")->required();
    info->callback([&line] { line.run = [&line] { return run_info(line.file); }; });

    CLI::App* dump = app.add_subcommand("dump", "Every number of a sector file as JSON");
    dump->add_option("FILE", line.file, "A sector file")->required();
    dump->add_flag("--json", line.dump_json, "As JSON: there is nothing else yet")->required();
    dump->callback([&line] { line.run = [&line] { return run_dump(line.file); }; });

    CLI::App* preview = app.add_subcommand("preview", "Picture of a region from above");
    preview->add_option("PATH", line.preview.path, "A folder, or one file")->required();
    preview->add_option("--out", line.preview.out, "The picture")->required()->type_name("FILE.png");
    preview->add_option("--metres-per-pixel", line.preview.metres_per_pixel, "By default as fits the region")
        ->check(metres_per_pixel());
    preview
        ->add_option(
            "--quantity", line.preview.quantity, "What colours the probes: " + joined(preview_quantities()))
        ->check(one_of(preview_quantities()))
        ->capture_default_str();
    preview->callback([&line] { line.run = [&line] { return run_preview(line.preview); }; });
}

// What --keep names: all and none stand alone.
std::vector<std::string> kept_sections(const std::vector<std::string>& names) {
    const std::vector<std::string> known = optional_section_names();
    if (names == std::vector<std::string>{"all"})
        return known;
    if (names == std::vector<std::string>{"none"})
        return {};
    for (const std::string& name : names) {
        if (std::ranges::find(known, name) == known.end())
            throw CLI::ValidationError("--keep",
                                       "\"" + name + "\" is no optional section: there are " + joined(known) +
                                           "; all and none stand alone");
    }
    return names;
}

void add_strip(CLI::App& app, CommandLine& line) {
    CLI::App* strip = app.add_subcommand("strip", "The same sectors with fewer sections, or compressed");
    // Quality is for people who bake, the rest for games and their tools.
    line.strip.keep = optional_section_names();
    std::erase(line.strip.keep, "quality");
    strip->add_option("PATH", line.strip.in, "A folder, or one file")->required();
    strip->add_option("--out", line.strip.out, "Folder or file to write")->required();
    strip
        ->add_option_function<std::vector<std::string>>(
            "--keep",
            [&line](const std::vector<std::string>& names) { line.strip.keep = kept_sections(names); },
            "Optional sections to keep: " + joined(optional_section_names()) +
                "; all, or none; the default is all but quality")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("SECTION,...");
    strip
        ->add_option_function<std::string>(
            "--codec",
            [&line](const std::string& codec) { line.strip.compress = codec == "zstd"; },
            "How sections are stored: raw, zstd; the default is raw")
        ->check(one_of({"raw", "zstd"}));
    strip->callback([&line] { line.run = [&line] { return run_strip(line.strip); }; });
}

void add_diff(CLI::App& app, CommandLine& line) {
    CLI::App* diff = app.add_subcommand("diff", "What changed between two files or folders");
    diff->add_option("A", line.diff.first, "A file or folder")->required();
    diff->add_option("B", line.diff.second, "What it is compared with")->required();
    diff->add_flag("--json", line.diff.json, "Print JSON, one object per line");
    CLI::Option* png =
        diff->add_option("--png", line.diff.png, "Draw what changed, from above")->type_name("FILE.png");
    diff->add_option("--metres-per-pixel", line.diff.metres_per_pixel, "Of the picture")
        ->check(metres_per_pixel())
        ->needs(png);
    diff->callback([&line] { line.run = [&line] { return run_diff(line.diff); }; });
}

// The light of a moment: by the time of day, or by numbers.
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

void add_relight(CLI::App& app, CommandLine& line) {
    CLI::App* relight = app.add_subcommand("relight", "The ambient light at places, as a game gets it");
    RelightRequest& request = line.relight;
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
    relight->add_option("--by", request.by, "Which probes: nearest, trilinear")
        ->check(one_of({"nearest", "trilinear"}))
        ->capture_default_str();
    relight->add_option("--offset", request.offset_m, "Metres along the normal at which probes are asked")
        ->check(finite_number());
    relight->add_flag_callback(
        "--no-interiors", [&request] { request.interiors = false; }, "As if there were none");
    relight->add_flag("--json", request.json, "Print JSON, one object per place");
    add_light(*relight, request.light);
    relight->callback([&line, at, points] {
        if (at->count() == 0 && points->count() == 0)
            throw CLI::RequiredError("--at with --normal, or --points,");
        line.run = [&line] { return run_relight(line.relight); };
    });
}

// Gives the exit status.
int end_parse(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0)
        return app.exit(error);  // --help, --version
    const auto commands = app.get_subcommands();
    if (commands.empty() && !app.remaining().empty()) {
        complain("there is no command \"" + app.remaining().front() + "\"; drtv --help lists them");
        return exit_usage;
    }
    const std::string command = commands.empty() ? "drtv" : "drtv " + commands.front()->get_name();
    const std::string prefix = commands.empty() ? "" : commands.front()->get_name() + ": ";
    complain(prefix + error.what() + "; " + command + " --help says more");
    return exit_usage;
}

int run(int argc, char** argv) {
    CLI::App app{"drtv validates, shows, compares, strips and relights sector files.", "drtv"};
    app.require_subcommand(1);
    app.set_version_flag("--version",
                         "drtv " DRTV_VERSION ", sector format 1." DRTV_VERSION_TEXT(DRTV_FORMAT_MINOR));
    app.footer(
        "drtv COMMAND --help lists a command's options.\n"
        "Exit status: 0 valid or equal, 1 wrong usage, 2 a file cannot be read or written, 3 a file is "
        "invalid,\n"
        "4 diff found a difference");
    CommandLine line;
    add_checks(app, line);
    add_views(app, line);
    add_strip(app, line);
    add_diff(app, line);
    add_relight(app, line);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return end_parse(app, error);
    }
    return line.run();
}

}  // namespace
}  // namespace drtv::tool

int main(int argc, char** argv) {
    const int exit_code = drtv::tool::run(argc, argv);
    // A full disk behind a redirected stdout must not look like success.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
        return exit_code;
    drtv::tool::complain("cannot write to standard output");
    return drtv::tool::exit_unreadable;
}
