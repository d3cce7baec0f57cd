// Vectors of three numbers.
#pragma once

#include <drtv/conventions.h>

#include <cmath>

namespace drtv {

[[nodiscard]] inline bool is_finite(const Float3& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

[[nodiscard]] inline double squared_distance(const Double3& a, const Double3& b) {
    const double x = a[0] - b[0];
    const double y = a[1] - b[1];
    const double z = a[2] - b[2];
    return x * x + y * y + z * z;
}

[[nodiscard]] inline float dot(const Float3& a, const Float3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// In double, so that neither tiny nor huge vectors are lost. `otherwise` for one without a direction.
[[nodiscard]] inline Float3 normalised(const Float3& v, const Float3& otherwise) {
    const double x = double{v[0]};
    const double y = double{v[1]};
    const double z = double{v[2]};
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!std::isfinite(length) || !(length > 0))
        return otherwise;
    return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

}  // namespace drtv
