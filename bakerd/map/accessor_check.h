// Checks the accessors of a glTF document: types, and the buffer views that they name.
#pragma once

#include "bakerd/map/json_checker.h"

namespace drtv::map {

// Dense and sparse parts alike. Whether the elements lie inside the views shows when they are read
// (accessor.h).
[[nodiscard]] CheckResult check_accessors(const Checker& check);

}  // namespace drtv::map
