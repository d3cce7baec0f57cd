// Checks the lights, nodes and scenes of a glTF document.
#pragma once

#include "bakerd/map/json_checker.h"

namespace drtv::map {

// Types and references, each by itself; how nodes hang together is node_tree_check.h's. REQUIRES: the root's
// `extensions` is an object where it is there, accessors and meshes are checked.
[[nodiscard]] CheckResult check_nodes(const Checker& check, Json& root);

}  // namespace drtv::map
