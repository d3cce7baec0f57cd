// Checks how the nodes of a glTF document hang together.
#pragma once

#include "bakerd/map/json_checker.h"

namespace drtv::map {

// Each node has at most one parent, no path leads back, and a scene holds each of its roots once: then every
// walk over children ends, and meets no node twice. REQUIRES: nodes and scenes are checked.
[[nodiscard]] CheckResult check_node_tree(const Json& root);

}  // namespace drtv::map
