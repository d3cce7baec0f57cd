#include "tests/ambient/ambient_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace drtv::test {
namespace {

constexpr double darkest_mean = 0.001;

}  // namespace

double Errors::quantile(double share) const {
    if (rms.empty())
        throw std::runtime_error("no place is bright enough for " + name);
    std::vector<double> sorted = rms;
    std::ranges::sort(sorted);
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

const Errors& find(const std::vector<Errors>& of, const std::string& name) {
    const auto found = std::ranges::find(of, name, &Errors::name);
    if (found == of.end())
        throw std::runtime_error("no errors are named " + name);
    return *found;
}

std::vector<Errors> errors_of(const std::vector<Place>& places) {
    std::vector<Errors> errors;
    double truth = 0;
    for (const Place& place : places) {
        if (place.mean < darkest_mean)
            continue;
        truth += place.mean;
        for (std::size_t n = 0; n < place.sums.all().size(); ++n) {
            const auto& [name, sum] = place.sums.all()[n];
            if (n == errors.size())
                errors.push_back({name, {}, 0});
            const auto count = static_cast<double>(sum.count);
            errors[n].rms.push_back(std::sqrt(sum.squares / count) / place.mean);
            errors[n].bias += sum.difference / count;
        }
    }
    for (Errors& of : errors)
        of.bias /= truth;
    return errors;
}

void print(const char* title, const std::vector<Errors>& errors) {
    std::printf("%-54s %8s %8s %8s\n", title, "median", "p90", "bias");
    for (const Errors& of : errors)
        std::printf("  %-52s %8.3f %8.3f %+8.3f\n", of.name.c_str(), of.median(), of.quantile(0.9), of.bias);
}

}  // namespace drtv::test
