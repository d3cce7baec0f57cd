// The header at the start of a file (SPEC.md, section 4.1).
#pragma once

#include <drtv/read.h>

#include "bytes.h"

namespace drtv {

// Fails at the first field that breaks its rule. Afterwards the table of sections lies inside the file, and
// the checksum over both is right. Any bytes may be given; allocates for the message only.
ReadStatus check_header(ByteSpan file);

}  // namespace drtv
