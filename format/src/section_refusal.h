// How a rule for the content of a section says that it is broken.
#pragma once

#include "read_failure.h"
#include "sections.h"

#include <cstddef>

namespace drtv {

// The section breaks a rule at byte `at` of its decoded bytes.
template <class... Parts>
[[nodiscard]] ReadStatus refuse(const Section& section, std::size_t at, const Parts&... parts) {
    return fail(ReadError::bad_section, section.place.at(at), parts...);
}

// The section breaks a rule before it is decoded.
template <class... Parts>
[[nodiscard]] ReadStatus refuse(const SectionEntry& entry, const Parts&... parts) {
    return fail(ReadError::bad_section, entry.offset, section_name(entry), parts...);
}

}  // namespace drtv
