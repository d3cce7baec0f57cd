// Checks the samplers, textures and materials of a glTF document.
#pragma once

#include "bakerd/map/json_checker.h"

namespace drtv::map {

// Types and references only; ranges of values show when a material is imported. REQUIRES: images are checked.
[[nodiscard]] CheckResult check_materials(const Checker& check);

}  // namespace drtv::map
