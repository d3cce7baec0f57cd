// The one way in which a part of a program fails: a sentence, and how the program ends.
#pragma once

#include "cli/exit_code.h"

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace drtv::cli {

struct Failure {
    ExitCode code = exit_usage;
    std::string sentence;   // what, where, value
    bool may_pass = false;  // by itself: another attempt may succeed
};

template <class Value>
using Result = tl::expected<Value, Failure>;

[[nodiscard]] inline tl::unexpected<Failure> fail(ExitCode code, std::string sentence) {
    return tl::unexpected(Failure{code, std::move(sentence)});
}

}  // namespace drtv::cli
