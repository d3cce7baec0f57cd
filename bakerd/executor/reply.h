// A worker's answer to one kind of question.
#pragma once

#include "bakerd/worker/requests.h"

#include <utility>
#include <variant>

#include <tl/expected.hpp>

namespace drtv::executor {

// What was asked for, or why it could not be done.
template <class Answer>
using Reply = tl::expected<Answer, worker::RequestFailure>;

// What of an outcome was asked for. An answer to another question is a failure.
template <class Answer, class Outcome>
[[nodiscard]] Reply<Answer> reply_of(Outcome outcome) {
    if (auto* answer = std::get_if<Answer>(&outcome))
        return std::move(*answer);
    if (auto* failure = std::get_if<worker::RequestFailure>(&outcome))
        return tl::unexpected(std::move(*failure));
    return tl::unexpected(worker::RequestFailure{"the worker gave an answer to another question", false});
}

}  // namespace drtv::executor
