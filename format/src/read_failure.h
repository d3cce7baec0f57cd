// How reading fails.
#pragma once

#include <drtv/read.h>

#include "sentence.h"

#include <cstdint>

namespace drtv {

// At byte `offset` of the file. The parts make the message: it costs nothing while all is well.
template <class... Parts>
[[nodiscard]] ReadStatus fail(ReadError error, std::uint64_t offset, const Parts&... parts) {
    return {error, offset, sentence(parts...)};
}

}  // namespace drtv
