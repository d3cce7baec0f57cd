#include "tests/reference/check_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::reference {
namespace {

constexpr double sigmas = 3;

// By how much Student's quantile at so many degrees of freedom exceeds the normal one (Abramowitz and
// Stegun, 26.7.5).
double widened(double freedom) {
    const double z = sigmas, z2 = z * z;
    const double first = (z2 + 1) / 4, second = ((5 * z2 + 16) * z2 + 3) / 96,
                 third = (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
    return 1 + first / freedom + second / (freedom * freedom) + third / (freedom * freedom * freedom);
}

}  // namespace

Figures figures_of(const std::vector<ProbeFigures>& probes, double product_error, bool even) {
    Figures figures;
    double sum = 0, squares = 0, errors2 = 0, noise2 = 0, worst = -1;
    std::vector<double> difference, relative;  // a probe's sum
    for (std::size_t p = 0; p < probes.size(); ++p) {
        double here = 0, here2 = 0, size = 0, reference_noise = 0, product_noise = 0;
        for (const Compared& n : probes[p].numbers) {
            const double d = n.product - n.reference;
            here += d;
            here2 += d * d;
            size += std::abs(n.reference);
            errors2 += n.error * n.error;
            reference_noise += n.error;
            product_noise += product_error * n.scale;
            const double product = product_error * n.scale, both = n.error * n.error + product * product;
            if (n.error > 0)
                figures.chi_squared += d * d / (n.error * n.error);
            if (both > 0)
                figures.chi_squared_both += d * d / both;
            ++figures.numbers;
        }
        if (probes[p].numbers.empty())
            continue;
        ++figures.probes;
        figures.mean += size;
        noise2 += reference_noise * reference_noise + product_noise * product_noise;
        difference.push_back(here);
        if (size > 0)
            relative.push_back(here / size);
        sum += here;
        squares += here2;
        if (here2 / static_cast<double>(probes[p].numbers.size()) <= worst)
            continue;
        worst = here2 / static_cast<double>(probes[p].numbers.size());
        figures.worst_probe = p;
        const auto larger = [](const Compared& a, const Compared& b) {
            return std::abs(a.product - a.reference) < std::abs(b.product - b.reference);
        };
        figures.worst_number = static_cast<std::size_t>(
            std::max_element(probes[p].numbers.begin(), probes[p].numbers.end(), larger) -
            probes[p].numbers.begin());
    }
    if (figures.numbers == 0)
        return figures;
    const auto count = static_cast<double>(figures.numbers),
               probe_count = static_cast<double>(figures.probes);
    figures.mean /= count;
    figures.chi_squared /= count;
    figures.chi_squared_both /= count;
    if (!(figures.mean > 0)) {
        figures.systematic = sum == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), sum);
        return figures;
    }
    std::nth_element(relative.begin(), relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2),
                     relative.end());
    figures.median = relative[relative.size() / 2];
    double spread = 0;
    for (const double d : difference)
        spread += std::pow(d - sum / probe_count, 2);
    figures.systematic = sum / count / figures.mean;
    figures.error_by_spread = figures.probes > 1 ? widened(probe_count - 1) *
                                                       std::sqrt(spread * probe_count / (probe_count - 1)) /
                                                       count / figures.mean
                                                 : std::numeric_limits<double>::infinity();
    figures.error_by_noise = std::sqrt(noise2) / count / figures.mean;
    figures.systematic_error = product_error > 0 && even
                                   ? std::min(figures.error_by_spread, figures.error_by_noise)
                                   : figures.error_by_spread;
    figures.rms = std::sqrt(squares / count) / figures.mean;
    figures.reference_error = std::sqrt(errors2 / count) / figures.mean;
    return figures;
}

bool off(const Figures& figures, double limit) {
    return std::abs(figures.systematic) > limit + sigmas * figures.systematic_error;
}

}  // namespace drtv::reference
