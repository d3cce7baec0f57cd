// What a command line says of a view. Each fails with a sentence that names option and value.
#pragma once

#include "bakerd/picture/camera.h"
#include "bakerd/picture/render_request.h"
#include "bakerd/picture/view_rule.h"
#include "format/cli/failure.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>

namespace drtv::picture {

[[nodiscard]] cli::Result<Size> read_size(const std::string& text);
// Nothing where there is no camera.
[[nodiscard]] cli::Result<std::optional<View>> read_view(const RenderRequest& request);
[[nodiscard]] cli::Result<std::optional<trace::WorldRectangle>> read_region(
    const std::optional<std::string>& text);

[[nodiscard]] glm::dvec3 in_millimetres(const glm::vec3& place);
// "1,2.5,3", in millimetres.
[[nodiscard]] std::string place_text(const glm::vec3& place);

}  // namespace drtv::picture
