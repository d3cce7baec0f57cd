// How far a baked quantity lies from the reference, over many probes.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace drtv::reference {

// One number of one probe. `error` is the reference's, the file's rounding included; `scale` is what the
// product's relative error is of.
struct Compared {
    double product = 0, reference = 0, error = 0, scale = 0;
    std::string name;  // "g[2][1]"
};

// What one probe adds to a quantity.
struct ProbeFigures {
    glm::dvec3 position{};
    std::size_t number = 0;  // in its sector
    std::vector<Compared> numbers;
};

struct Figures {
    std::size_t probes = 0, numbers = 0;
    double mean = 0;        // of |reference|
    double systematic = 0;  // mean of product - reference, over `mean`
    // Standard errors of `systematic`. From how the probes differ, so that all noise is in it, as well as
    // what is really different between them (widened for few probes as Student's law asks for at 3 sigma);
    // and from the errors given, as if all of a probe's numbers erred together.
    double error_by_spread = 0, error_by_noise = 0;
    double systematic_error =
        0;  // the one to trust: the lesser, that by noise only if the product's noise is known
    double median =
        0;  // over probes, of each one's own systematic difference: where few bright probes make the mean
    double rms = 0;               // of product - reference, over `mean`
    double reference_error = 0;   // rms of the reference's standard errors, over `mean`
    double chi_squared = 0;       // a number, with the reference's errors alone
    double chi_squared_both = 0;  // and with the product's
    std::size_t worst_probe = 0,
                worst_number =
                    0;  // index into the probes; the largest difference of the probe with the largest rms
};

// `product_error`: standard error of the product's numbers, relative to their scales; 0: not known. Where it
// is not `even`, it is too rough to judge the systematic difference by.
[[nodiscard]] Figures figures_of(const std::vector<ProbeFigures>& probes, double product_error,
                                 bool even = true);

// Whether the systematic difference is over `limit` by more than 3 standard errors.
[[nodiscard]] bool off(const Figures& figures, double limit);

}  // namespace drtv::reference
