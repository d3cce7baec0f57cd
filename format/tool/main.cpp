// drtv: validates, shows, compares, strips, pictures and relights sector files. Here the command line is
// taken apart.
#include "cli/option_checks.h"
#include "cli/parse.h"
#include "cli/report.h"
#include "cli/version.h"
#include "commands.h"
#include "dot_colour.h"
#include "relight_options.h"

#include <drtv/version.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace drtv::tool {

namespace {

// What the command line says.
struct CommandLine {
    ValidateRequest validate;
    PreviewRequest preview{{}, {}, 0, "relit", {}, {}};
    StripRequest strip;
    TilesRequest tiles;
    DiffRequest diff;
    RelightRequest relight;
    std::string file;  // of info and dump
    // Said for the reader of a script; there is no other way yet.
    bool full = false;
    bool dump_json = false;
    // The command. Set when the line has been parsed.
    std::function<cli::Result<cli::ExitCode>()> run;
};

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
    validate->add_flag(
        "--whole", request.whole, "A folder without a manifest, or of an unfinished job, is invalid too");
    validate
        ->add_option("--ignore", request.ignored, "Leave out findings of this code; drtv issues lists them")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("CODE");
    validate->add_option("--max-findings", request.max_findings, "Findings shown per file")
        ->check(cli::whole_number(1, 1'000'000))
        ->capture_default_str();
    validate->callback([&line] { line.run = [&line] { return run_validate(line.validate); }; });

    CLI::App* issues = app.add_subcommand("issues", "The table of all that validate can find");
    issues->callback([&line] { line.run = run_issues; });
}

void add_views(CLI::App& app, CommandLine& line) {
    CLI::App* info = app.add_subcommand("info", "What a sector file, or a folder of them, holds");
    info->add_option("FILE", line.file, "A sector file, or a folder of them")->required();
    info->callback([&line] { line.run = [&line] { return run_info(line.file); }; });

    CLI::App* dump = app.add_subcommand("dump", "Every number of a sector file as JSON");
    dump->add_option("FILE", line.file, "A sector file")->required();
    dump->add_flag("--json", line.dump_json, "As JSON: there is nothing else yet")->required();
    dump->callback([&line] { line.run = [&line] { return run_dump(line.file); }; });

    CLI::App* preview = app.add_subcommand("preview", "Picture of a region from above");
    preview->add_option("PATH", line.preview.path, "A folder, or one file")->required();
    preview->add_option("--out", line.preview.out, "The picture")->required()->type_name("FILE.png");
    preview->add_option("--metres-per-pixel", line.preview.metres_per_pixel, "By default as fits the region")
        ->check(cli::number_below(1000));
    preview
        ->add_option("--quantity",
                     line.preview.quantity,
                     "What colours the probes: " + cli::joined(dot_quantity_names()))
        ->check(cli::one_of(dot_quantity_names()))
        ->capture_default_str();
    preview
        ->add_option("--under",
                     line.preview.under,
                     "A picture to lie under the probes: what bakerd render --top makes")
        ->type_name("FILE.png");
    CLI::Option* time = preview->add_option("--time", line.preview.light.time, "Relit at this time of a day")
                            ->type_name("HH:MM");
    preview
        ->add_option("--gradients",
                     line.preview.light.gradients,
                     "The day (light.schema.json) instead of the built-in one")
        ->needs(time)
        ->type_name("FILE.json");
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
                                       "\"" + name + "\" is no optional section: there are " +
                                           cli::joined(known) + "; all and none stand alone");
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
            "Optional sections to keep: " + cli::joined(optional_section_names()) +
                "; all, or none; the default is all but quality")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("SECTION,...");
    strip
        ->add_option_function<std::string>(
            "--codec",
            [&line](const std::string& codec) { line.strip.compress = codec == "zstd"; },
            "How sections are stored: raw, zstd; the default is raw")
        ->check(cli::one_of({"raw", "zstd"}));
    strip->callback([&line] { line.run = [&line] { return run_strip(line.strip); }; });
}

void add_tiles(CLI::App& app, CommandLine& line) {
    CLI::App* tiles =
        app.add_subcommand("tiles", "How much sky the ground sees, by column, for the distance");
    tiles->add_option("PATH", line.tiles.path, "A folder, or one file")->required();
    tiles->add_option("--out", line.tiles.out, "The file of tiles to write")->required();
    tiles->callback([&line] { line.run = [&line] { return run_tiles(line.tiles); }; });
}

void add_diff(CLI::App& app, CommandLine& line) {
    CLI::App* diff = app.add_subcommand("diff", "What changed between two files or folders");
    diff->add_option("A", line.diff.first, "A file or folder")->required();
    diff->add_option("B", line.diff.second, "What it is compared with")->required();
    diff->add_flag("--json", line.diff.json, "Print JSON, one object per line");
    CLI::Option* png =
        diff->add_option("--png", line.diff.png, "Draw what changed, from above")->type_name("FILE.png");
    diff->add_option("--metres-per-pixel", line.diff.metres_per_pixel, "Of the picture")
        ->check(cli::number_below(1000))
        ->needs(png);
    diff->callback([&line] { line.run = [&line] { return run_diff(line.diff); }; });
}

}  // namespace
}  // namespace drtv::tool

int main(int argc, char** argv) {
    using namespace drtv;
    CLI::App app{"drtv validates, shows, compares, strips and relights sector files.", "drtv"};
    app.require_subcommand(1);
    app.set_version_flag(
        "--version",
        cli::version_text(
            "drtv", cli::built_isa_class(), "sector format 1." DRTV_VERSION_TEXT(DRTV_FORMAT_MINOR)));
    app.footer("drtv COMMAND --help lists a command's options.\n\n" + cli::exit_code_help("drtv"));
    tool::CommandLine line;
    tool::add_checks(app, line);
    tool::add_views(app, line);
    tool::add_strip(app, line);
    tool::add_tiles(app, line);
    tool::add_diff(app, line);
    tool::add_relight(app, line.relight, line.run);
    if (const auto ended = cli::parse(app, argc, argv))
        return *ended;
    return cli::end_program(line.run());
}
