#include "read_failure.h"

namespace drtv {

ReadStatus failure_of(ReadError error, std::uint64_t offset, const SentencePart* parts, std::size_t count) {
    return {error, offset, sentence_of(parts, count)};
}

}  // namespace drtv
