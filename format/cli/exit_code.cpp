#include "exit_code.h"

#include <array>

namespace drtv::cli {
namespace {

constexpr std::array meanings = {
    ExitMeaning{exit_done, "done; what was checked is valid, what was compared is equal", true, true, true},
    ExitMeaning{
        exit_usage, "wrong usage: an argument, a setting, a job that does not exist", true, true, true},
    ExitMeaning{exit_unreadable,
                "something cannot be read or written: a file, a folder, a full disk, an address to listen on",
                true,
                true,
                true},
    ExitMeaning{exit_invalid,
                "what was read is invalid: a file, a map, a map without ground, a folder of another map",
                true,
                true,
                true},
    ExitMeaning{exit_different, "diff found a difference", true, false, false},
    ExitMeaning{exit_job_failed, "the job failed", false, true, false},
    ExitMeaning{exit_unfinished, "the job was cancelled, or is not finished", false, true, false},
    ExitMeaning{exit_server, "bakerd cannot be reached, or refused", false, true, false},
    ExitMeaning{exit_timeout, "the time of --timeout is over; the job goes on", false, true, false},
    ExitMeaning{exit_differs,
                "this node must not bake for the daemon: its build, or its instruction set class, is another",
                false,
                false,
                true},
    ExitMeaning{exit_interrupted, "interrupted by ctrl-C; a job goes on", true, true, true},
};

bool is_of(const ExitMeaning& meaning, std::string_view program) {
    return program == "drtv" ? meaning.drtv : program == "bake" ? meaning.bake : meaning.bakerd;
}

}  // namespace

std::span<const ExitMeaning> exit_meanings() {
    return meanings;
}

std::string exit_code_help(std::string_view program) {
    std::string text = "Exit status:";
    for (const ExitMeaning& meaning : meanings) {
        if (!is_of(meaning, program))
            continue;
        const std::string number = std::to_string(meaning.code);
        text += "\n  " + number + std::string(5 - number.size(), ' ') + std::string(meaning.meaning);
    }
    return text;
}

}  // namespace drtv::cli
