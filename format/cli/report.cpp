#include "report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <string_view>
#include <vector>

namespace drtv::cli {
namespace {

bool as_json = false;
std::vector<std::string> warnings;

void say(const char* kind,
         std::string_view before,
         const std::string& sentence,
         std::optional<int> exit_code) {
    if (!as_json) {
        std::fprintf(stderr,
                     "%s: %.*s%s\n",
                     program_invocation_short_name,
                     static_cast<int>(before.size()),
                     before.data(),
                     sentence.c_str());
        return;
    }
    using Json = nlohmann::ordered_json;
    Json json;
    json["kind"] = kind;
    json["program"] = program_invocation_short_name;
    json["message"] = sentence;
    if (exit_code)
        json["exit_code"] = *exit_code;
    std::fprintf(stderr, "%s\n", json.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
}

}  // namespace

void report_as_json(bool json) {
    as_json = json;
}

ExitCode complain(const Failure& failure) {
    say("error", "", failure.sentence, failure.code);
    return failure.code;
}

void warn(const std::string& sentence) {
    warnings.push_back(sentence);
    say("warning", "warning: ", sentence, std::nullopt);
}

const std::vector<std::string>& warnings_told() {
    return warnings;
}

void note(const std::string& sentence) {
    say("note", "", sentence, std::nullopt);
}

int end_program(const Result<ExitCode>& ended) {
    const ExitCode code = ended ? *ended : complain(ended.error());
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
        return code;
    // Whatever else was found: what told it is cut off.
    return complain({exit_unreadable, "cannot write to standard output"});
}

}  // namespace drtv::cli
