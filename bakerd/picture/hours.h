// The light of each picture of a run.
#pragma once

#include "bakerd/picture/render_request.h"
#include "format/cli/failure.h"
#include "format/kit/light_request.h"

#include <memory>
#include <string>
#include <vector>

namespace drtv::picture {

struct Hour {
    std::string time;  // empty: light by numbers
    std::unique_ptr<kit::RequestedLight> light = std::make_unique<kit::RequestedLight>();
};

struct Hours {
    std::vector<Hour> shown;  // one at least
    Hour noon;                // of the same day; of light by numbers the same again
};

// Without any light it is noon.
[[nodiscard]] cli::Result<Hours> read_hours(const RenderRequest& request);

}  // namespace drtv::picture
