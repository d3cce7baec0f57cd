// What a program says besides its data: one sentence each on standard error, as text or, under --json, as an
// object per line (format/message.schema.json).
#pragma once

#include "cli/failure.h"

#include <string>
#include <vector>

namespace drtv::cli {

// From now on.
void report_as_json(bool json);

// "drtv: <sentence>". Gives the failure's exit code.
ExitCode complain(const Failure& failure);

// "drtv: warning: <sentence>"
void warn(const std::string& sentence);

// All warnings so far.
[[nodiscard]] const std::vector<std::string>& warnings_told();

// "drtv: <sentence>": neither wrong nor a warning.
void note(const std::string& sentence);

// The exit code of a command that ended so, after the complaint where it failed. Fails, too, where standard
// output could not be written: a full disk behind a redirection must not look like success.
[[nodiscard]] int end_program(const Result<ExitCode>& ended);

}  // namespace drtv::cli
