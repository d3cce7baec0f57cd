// Checks the meshes of a glTF document: what their primitives name, and that they can be read at all.
#pragma once

#include "bakerd/map/json_checker.h"

namespace drtv::map {

// Also leaves out morph targets, which no bake needs. REQUIRES: accessors are checked.
[[nodiscard]] CheckResult check_meshes(const Checker& check);

}  // namespace drtv::map
