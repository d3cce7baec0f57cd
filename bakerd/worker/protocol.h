// Requests and answers as lines of text: one JSON object per line, requests on the worker's standard input,
// answers on its standard output.
#pragma once

#include "bakerd/worker/requests.h"

#include <optional>
#include <string>
#include <string_view>

namespace drtv::worker {

// Without the line's end.
[[nodiscard]] std::string encode(const Request& request);
[[nodiscard]] std::string encode(const Answer& answer);

// Nothing when the line is not one.
[[nodiscard]] std::optional<Request> decode_request(std::string_view line);
[[nodiscard]] std::optional<Answer> decode_answer(std::string_view line);

}  // namespace drtv::worker
