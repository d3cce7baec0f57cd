// The places that `drtv relight` is asked for.
#pragma once

#include <drtv/conventions.h>

#include <string>
#include <vector>

namespace drtv::tool {

struct RelightPoint {
    Double3 at{};
    Float3 normal{};  // unit
};

// One point from arguments, "x,y,z" each. False, and a complaint, where one is wrong.
[[nodiscard]] bool read_point(const std::string& at,
                              const std::string& normal,
                              std::vector<RelightPoint>& points);

// A JSON object per line, {"at": [x, y, z], "normal": [x, y, z]}, of a file or, for "-", of standard input;
// empty lines do not count. Gives the exit code: not exit_valid, and a complaint with the line's number,
// where one is wrong.
[[nodiscard]] int read_points(const std::string& path, std::vector<RelightPoint>& points);

}  // namespace drtv::tool
