// The rules inside a section of local transfer (SPEC.md, section 5.8).
#pragma once

#include <drtv/read.h>

#include "sections.h"

#include <cstddef>

namespace drtv {

// Fails with `bad_section` at the first byte that breaks a rule. Where it does not, all parts lie inside the
// section, and all that a pair names is there. REQUIRES: at least the header's 16 bytes.
ReadStatus check_local_transfer_content(const Section& section, std::size_t probe_count);

}  // namespace drtv
