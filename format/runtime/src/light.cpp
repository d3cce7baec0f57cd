#include <drtv/light.h>

#include "vector.h"

#include <cmath>
#include <cstddef>

namespace drtv {
namespace {

// Inverse of the matrix of integrals of Y_i Y_j over the upper hemisphere: 8 and -4 sqrt(3) between Y0 and
// Y2, 2 for Y1 and Y3.
constexpr float fit_same = 8;
constexpr float fit_cross = -6.92820323f;
constexpr float fit_side = 2;

// Normal equations of a fit of two bands, in double: sums of w Y Y^T and of w Y f.
class SkyFit {
  public:
    void add(const Float3& direction, const Float3& radiance, double weight) {
        const Float4 y = evaluate_sh(direction);
        for (std::size_t i = 0; i < sh_count; ++i) {
            const double weighted = weight * double{y[i]};
            for (std::size_t j = 0; j < sh_count; ++j)
                matrix_[i][j] += weighted * double{y[j]};
            for (std::size_t c = 0; c < channel_count; ++c)
                sums_[i][c] += weighted * double{radiance[c]};
        }
    }

    // Gaussian elimination; the matrix is symmetric and has no negative eigenvalue. The small addition to its
    // diagonal decides what the samples leave open.
    [[nodiscard]] DistantLight solve() {
        constexpr double relative_addition = 1e-9;
        const double trace = matrix_[0][0] + matrix_[1][1] + matrix_[2][2] + matrix_[3][3];
        if (!(trace > 0))
            return {};
        for (std::size_t i = 0; i < sh_count; ++i)
            matrix_[i][i] += relative_addition * trace;
        for (std::size_t k = 0; k < sh_count; ++k) {
            for (std::size_t i = k + 1; i < sh_count; ++i) {
                const double factor = matrix_[i][k] / matrix_[k][k];
                for (std::size_t j = k; j < sh_count; ++j)
                    matrix_[i][j] -= factor * matrix_[k][j];
                for (std::size_t c = 0; c < channel_count; ++c)
                    sums_[i][c] -= factor * sums_[k][c];
            }
        }
        DistantLight light{};
        for (std::size_t c = 0; c < channel_count; ++c) {
            std::array<double, sh_count> a{};
            for (std::size_t k = sh_count; k-- > 0;) {
                double rest = sums_[k][c];
                for (std::size_t j = k + 1; j < sh_count; ++j)
                    rest -= matrix_[k][j] * a[j];
                a[k] = rest / matrix_[k][k];
                light[c][k] = static_cast<float>(a[k]);
            }
        }
        return light;
    }

  private:
    std::array<std::array<double, sh_count>, sh_count> matrix_{};
    std::array<std::array<double, channel_count>, sh_count> sums_{};
};

}  // namespace

DistantLight constant_sky(const Float3& radiance) {
    DistantLight light{};
    for (std::size_t c = 0; c < channel_count; ++c)
        light[c] = {radiance[c] / sh_y0, 0, 0, 0};
    return light;
}

DistantLight gradient_sky(const SkyColours& colours, const Float3& to_sun) {
    const Float3 side = normalised({to_sun[0], to_sun[1], 0}, {});
    DistantLight light{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        const float half_side = colours.sun_side[c] / 2;
        light[c] = {(colours.horizon[c] + half_side) / sh_y0,
                    half_side * side[1] / sh_y1,
                    (colours.zenith[c] - colours.horizon[c]) / sh_y1,
                    half_side * side[0] / sh_y1};
    }
    return light;
}

DistantLight fit_sky(std::span<const SkySample> samples) {
    SkyFit fit;
    for (const SkySample& sample : samples) {
        if (sample.direction[2] > 0 && sample.weight > 0 && is_finite(sample.direction) &&
            is_finite(sample.radiance) && std::isfinite(sample.weight))
            fit.add(sample.direction, sample.radiance, double{sample.weight});
    }
    return fit.solve();
}

DistantLight fit_sky(SkyRadiance radiance, void* user) {
    // Slices of equal height are of equal solid angle. Angles by turning, so that no C library's cosine
    // shows.
    constexpr int slices = 64;
    constexpr int steps = 64;
    constexpr double step_cosine = 0.99518472667219688624;  // of 2 pi / 64
    constexpr double step_sine = 0.09801714032956060200;
    SkyFit fit;
    for (int k = 0; k < slices; ++k) {
        const double z = (k + 0.5) / slices;
        const double r = std::sqrt(1 - z * z);
        double cosine = 1;
        double sine = 0;
        for (int n = 0; n < steps; ++n) {
            const Float3 w = {
                static_cast<float>(r * cosine), static_cast<float>(r * sine), static_cast<float>(z)};
            const Float3 found = radiance(w, user);
            if (is_finite(found))
                fit.add(w, found, 1);
            const double turned = cosine * step_cosine - sine * step_sine;
            sine = sine * step_cosine + cosine * step_sine;
            cosine = turned;
        }
    }
    return fit.solve();
}

DistantLight sun_as_sh(RelightMode mode, const Sun& sun) {
    const Float3 w = normalised(sun.direction, {});
    if (!(w[2] > 0))
        return {};
    const Float4 y = evaluate_sh(w);
    const Float4 fitted = {fit_same * y[0] + fit_cross * y[2],
                           fit_side * y[1],
                           fit_cross * y[0] + fit_same * y[2],
                           fit_side * y[3]};
    const Float4& shape = mode == RelightMode::literal ? y : fitted;
    DistantLight light{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t i = 0; i < sh_count; ++i)
            light[c][i] = sun.irradiance[c] * shape[i];
    }
    return light;
}

}  // namespace drtv
