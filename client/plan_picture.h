// A plan as a picture from above: north is up.
#pragma once

#include "drtv/v1/job.pb.h"
#include "format/cli/failure.h"
#include "format/image/underlay.h"

#include <string>

namespace drtv::client {

// Sectors that hit are green, near hits yellow, those to be baked red; what changed is framed in blue. Over
// `under` the colours let it through. Writes a PNG whole or not at all.
[[nodiscard]] cli::Result<void> write_plan_picture(const v1::Plan& plan,
                                                   const std::string& path,
                                                   const image::Underlay* under = nullptr);

}  // namespace drtv::client
