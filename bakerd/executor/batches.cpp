#include "bakerd/executor/batches.h"

#include <algorithm>
#include <numeric>

namespace drtv::executor {

std::vector<std::size_t> cut_batches(std::span<const double> seconds, const BatchRule& rule) {
    const auto threads = static_cast<double>(rule.threads);
    double left = std::accumulate(seconds.begin(), seconds.end(), 0.0);
    std::vector<std::size_t> ends;
    for (std::size_t next = 0; next < seconds.size() && ends.size() < rule.max_batches;) {
        const double share = left / (2 * static_cast<double>(std::max(rule.slots, std::size_t{1})));
        const double guided = std::max(share, rule.least_s * threads);
        const double most = rule.batch_s * threads;
        const double size = rule.is_last ? std::min(guided, most) : most;
        double taken = 0;
        // One thread bakes a sector: with fewer sectors than threads some would idle. The last sector may
        // stand out by half.
        for (std::size_t count = 0; next < seconds.size(); ++count) {
            if (count >= static_cast<std::size_t>(rule.threads) && taken + seconds[next] / 2 > size)
                break;
            taken += seconds[next++];
        }
        left -= taken;
        ends.push_back(next);
    }
    return ends;
}

std::size_t tasks_of_array(std::size_t slots) {
    constexpr std::size_t least = 16;
    return std::max(2 * slots, least);
}

double pilot_batch_s(std::size_t sectors, std::size_t slots, int threads) {
    const double share = static_cast<double>(sectors) / static_cast<double>(slots);
    return std::clamp(share / threads, 1.0, 2.0);
}

double long_batch_s(double batch_s, double load_s, double most_s) {
    return std::max(batch_s, std::min(8 * load_s, most_s));
}

double least_batch_s(double batch_s, double load_s) {
    return std::min(std::max(BatchRule().least_s, 2 * load_s), batch_s);
}

}  // namespace drtv::executor
