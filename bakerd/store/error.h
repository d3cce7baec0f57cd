// What can go wrong in the daemon. The service maps each code to the gRPC status of the same name.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace drtv::store {

enum class ErrorCode : std::uint8_t {
    invalid_argument,
    not_found,
    failed_precondition,
    aborted,
    resource_exhausted,
    data_loss,
    unavailable,
    internal
};

struct Error {
    ErrorCode code = ErrorCode::internal;
    std::string message;  // one sentence: what, where, value
};

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
    return tl::unexpected(Error{code, std::move(message)});
}

}  // namespace drtv::store
