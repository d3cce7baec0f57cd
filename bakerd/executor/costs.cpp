#include "bakerd/executor/costs.h"

#include <algorithm>

namespace drtv::executor {
namespace {

constexpr std::int64_t memory_step_bytes = std::int64_t{256} << 20;

}  // namespace

worker::Digest Costs::kind_of(const worker::BakeRequest& request) {
    return worker::answer_key({request.manifest, {}, request.settings, {}});
}

void Costs::learn(const worker::BakeRequest& request, const worker::TaskAnswer& answer) {
    std::int64_t& peak = peak_memory_[request.manifest];
    peak = std::max(peak, answer.peak_memory_bytes);
    constexpr double load_weight = 0.1;
    load_seconds_ += (load_seconds_ == 0 ? 1 : load_weight) * (answer.load_seconds - load_seconds_);
    // A rebake's seconds are those of a bake from nothing.
    const auto* result = std::get_if<worker::SectorResult>(&answer.what);
    if (result == nullptr || request.earlier)
        return;
    // Regions differ: what was baked last counts most.
    constexpr double weight = 0.02;
    const auto [mean, is_first] = seconds_.try_emplace(kind_of(request), result->seconds);
    if (!is_first)
        mean->second += weight * (result->seconds - mean->second);
}

void Costs::learn_too_little(const worker::BakeRequest& request, std::int64_t memory_bytes) {
    std::int64_t& peak = peak_memory_[request.manifest];
    // Three attempts must reach what a large map needs.
    peak = std::max(peak, 4 * memory_bytes);
}

double Costs::seconds(const worker::Digest& kind) const {
    const auto known = seconds_.find(kind);
    // A sector without probes takes no time that is worth a word; the cut needs some.
    return known == seconds_.end() ? 0 : std::max(known->second, 1e-4);
}

std::int64_t Costs::memory_bytes(const worker::BakeRequest& request) const {
    const auto known = peak_memory_.find(request.manifest);
    if (known == peak_memory_.end() || known->second == 0)
        return 0;
    // Other sectors need more; whole steps, so that arrays ask for the same.
    const std::int64_t wanted = known->second + known->second / 4;
    return (wanted / memory_step_bytes + 1) * memory_step_bytes;
}

}  // namespace drtv::executor
