// How reading fails.
#pragma once

#include <drtv/read.h>

#include "sentence.h"

#include <cstddef>
#include <cstdint>

namespace drtv {

[[nodiscard]] ReadStatus failure_of(ReadError error,
                                    std::uint64_t offset,
                                    const SentencePart* parts,
                                    std::size_t count);

// At byte `offset` of the file. The parts make the message: it costs nothing while all is well.
template <class... Parts>
[[nodiscard]] ReadStatus fail(ReadError error, std::uint64_t offset, const Parts&... parts) {
    const SentencePart all[] = {parts...};
    return failure_of(error, offset, all, sizeof...(parts));
}

}  // namespace drtv
