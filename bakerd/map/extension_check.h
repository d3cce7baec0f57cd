// The glTF extensions that a document may require, and where an element holds one.
#pragma once

#include "bakerd/map/json_checker.h"

#include <string_view>

namespace drtv::map {

// Checks extensionsUsed and extensionsRequired: arrays of names, and no required one is unknown to the
// importer. An extension that is only used may be passed over, so any name will do.
[[nodiscard]] CheckResult check_extensions(const Json& root);

// Whether a bake lacks something that a file says with this extension, or may.
[[nodiscard]] bool is_passed_over(std::string_view extension);

// The extension of this name on an element, or nullptr. REQUIRES: `extensions` was checked to be an object.
[[nodiscard]] Json* extension_of(Json& element, const char* name);

}  // namespace drtv::map
