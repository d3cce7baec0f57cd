// drtv: validates, shows, compares, strips and pictures sector files.
#include "commands.h"

#include <drtv/version.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace drtv::tool {

void complain(const std::string& sentence) {
    std::fprintf(stderr, "drtv: %s\n", sentence.c_str());
}

namespace {

constexpr const char* usage =
    "usage: drtv COMMAND ...\n"
    "\n"
    "  validate PATH... [--json]       check sector files, or all of a folder\n"
    "          [--quick | --full]      structure and checksums only, or everything (the default)\n"
    "          [--neighbours]          also the sectors of a folder against each other\n"
    "          [--warnings-as-errors] [--ignore CODE]... [--max-findings N]\n"
    "  info FILE                       what a sector file holds\n"
    "  dump FILE --json                every number of a sector file as JSON\n"
    "  diff A B [--json]               what changed between two files or folders\n"
    "          [--png FILE.png] [--metres-per-pixel M]\n"
    "  strip PATH --out PATH           the same sectors with fewer sections, or compressed\n"
    "          [--keep SECTION,...]    optional sections to keep: static_irradiance, light_groups,\n"
    "                                  local_transfer, convergence, interiors, quality; all, or none;\n"
    "                                  the default is all but quality\n"
    "          [--codec raw|zstd]      how sections are stored; raw is the default\n"
    "  preview DIR --out FILE.png      picture of a region from above\n"
    "          [--metres-per-pixel M] [--quantity relit|sky|errors|back_hits]\n"
    "  issues                          the table of all that validate can find\n"
    "  --version                       version of tool and format\n"
    "\n"
    "exit status: 0 valid or equal, 1 wrong usage, 2 a file cannot be read or written, 3 a file is invalid,\n"
    "4 diff found a difference\n";

int run(const std::vector<std::string>& arguments) {
    if (arguments.empty()) {
        std::fputs(usage, stderr);
        return exit_usage;
    }
    const std::string& command = arguments.front();
    const Arguments rest = Arguments(arguments).subspan(1);
    if (std::find(rest.begin(), rest.end(), "--help") != rest.end()) {
        std::fputs(usage, stdout);
        return exit_valid;
    }
    if (command == "validate")
        return run_validate(rest);
    if (command == "info")
        return run_info(rest);
    if (command == "dump")
        return run_dump(rest);
    if (command == "preview")
        return run_preview(rest);
    if (command == "strip")
        return run_strip(rest);
    if (command == "diff")
        return run_diff(rest);
    if (command == "issues")
        return run_issues(rest);
    if (command == "--help" || command == "-h" || command == "help") {
        std::fputs(usage, stdout);
        return exit_valid;
    }
    if (command == "--version") {
        std::puts("drtv " DRTV_VERSION ", sector format 1." DRTV_VERSION_TEXT(DRTV_FORMAT_MINOR));
        return exit_valid;
    }
    complain("unknown command \"" + command + "\"; drtv --help lists them");
    return exit_usage;
}

}  // namespace
}  // namespace drtv::tool

int main(int argc, char** argv) {
    const int exit_code = drtv::tool::run(std::vector<std::string>(argv + 1, argv + argc));
    // A full disk behind a redirected stdout must not look like success.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
        return exit_code;
    drtv::tool::complain("cannot write to standard output");
    return drtv::tool::exit_unreadable;
}
