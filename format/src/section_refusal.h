// How a rule for the content of a section says that it is broken.
#pragma once

#include "section_table.h"
#include "sections.h"
#include "sentence.h"

#include <cstddef>

namespace drtv {

// The section breaks a rule at byte `at` of its decoded bytes. The parts make the message: it costs nothing
// while all is well.
template <class... Parts>
[[nodiscard]] ReadStatus refuse(const Section& section, std::size_t at, const Parts&... parts) {
    return fail(ReadError::bad_section, section.place.at(at), sentence(parts...));
}

}  // namespace drtv
