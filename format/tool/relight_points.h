// The places that `drtv relight` is asked for.
#pragma once

#include "cli/failure.h"

#include <drtv/conventions.h>

#include <string>
#include <vector>

namespace drtv::tool {

struct RelightPoint {
    Double3 at{};
    Float3 normal{};  // unit
};

// One point from arguments, "x,y,z" each.
[[nodiscard]] cli::Result<std::vector<RelightPoint>> read_point(const std::string& at,
                                                                const std::string& normal);

// A JSON object per line, {"at": [x, y, z], "normal": [x, y, z]}, of a file or, for "-", of standard input;
// empty lines do not count. Where a line is wrong, the sentence has its number.
[[nodiscard]] cli::Result<std::vector<RelightPoint>> read_points(const std::string& path);

}  // namespace drtv::tool
