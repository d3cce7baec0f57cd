#include "bakerd/bake/convergence.h"

#include <algorithm>
#include <cmath>

namespace drtv::bake {

double relative_error(const BlockMeans& means) {
    double variance = 0;
    double total = 0;
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            double sum = 0;
            double squares = 0;
            for (const auto& block : means) {
                sum += block[c][b];
                squares += block[c][b] * block[c][b];
            }
            const double mean = sum / block_count;
            total += mean;
            variance += std::max(0.0, squares / block_count - mean * mean) / (block_count - 1);
        }
    }
    constexpr double values = channel_count * basis_count;
    return block_correction * std::sqrt(variance / values) / std::max(total / values, least_mean);
}

ErrorSummary summarise(std::vector<float> errors) {
    if (errors.empty())
        return {};
    std::ranges::sort(errors);
    const auto at = [&](double share) {
        return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1) + 0.5)];
    };
    return {at(0.5), at(0.95), errors.back()};
}

}  // namespace drtv::bake
