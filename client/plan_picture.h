// A plan as a picture from above: north is up.
#pragma once

#include "drtv/v1/job.pb.h"
#include "format/cli/failure.h"

#include <string>

namespace drtv::client {

// Sectors that hit are green, near hits yellow, those to be baked red; what changed is framed in blue. Writes
// a PNG whole or not at all.
[[nodiscard]] cli::Result<void> write_plan_picture(const v1::Plan& plan, const std::string& path);

}  // namespace drtv::client
