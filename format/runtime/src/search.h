// Searches as plain loops: standard libraries unroll theirs, and the amalgamated pair has 64 KB in all.
#pragma once

#include <cstddef>

namespace drtv {

// The first element from `first` on that is what is sought; the number of elements where none is.
template <class Range, class IsIt>
[[nodiscard]] std::size_t index_where(const Range& range, const IsIt& is_it, std::size_t first = 0) {
    while (first < range.size() && !is_it(range[first]))
        ++first;
    return first;
}

}  // namespace drtv
