#include "bakerd/bake/convergence.h"

#include <algorithm>

namespace drtv::bake {

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
