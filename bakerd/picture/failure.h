// Why there is no picture.
#pragma once

#include "format/kit/exit_code.h"

#include <string>

#include <tl/expected.hpp>

namespace drtv::picture {

struct Failure {
    kit::ExitCode code = kit::exit_usage;
    std::string sentence;
};

template <class Value>
using Expected = tl::expected<Value, Failure>;

[[nodiscard]] inline tl::unexpected<Failure> failed(kit::ExitCode code, std::string sentence) {
    return tl::unexpected(Failure{code, std::move(sentence)});
}

}  // namespace drtv::picture
