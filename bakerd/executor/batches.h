// Cuts sectors into batches, each of which one task of a cluster bakes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace drtv::executor {

struct BatchRule {
    double batch_s = 90;    // that a batch takes, where there is enough to do
    double least_s = 5;     // below, starting a task and loading the map would be most of it
    int threads = 1;        // of a task
    std::size_t slots = 1;  // tasks that run at the same time
    std::size_t max_batches = 1000;
    bool is_last = true;  // nothing waits behind these sectors
};

// Ends of consecutive runs of sectors, of which baking takes `seconds` of one thread each, above 0. Towards
// the end of all work batches become smaller, so that all slots end together: each takes its part of half of
// what is left (guided self-scheduling: Polychronopoulos and Kuck 1987). Sectors beyond `max_batches` are in
// none.
[[nodiscard]] std::vector<std::size_t> cut_batches(std::span<const double> seconds, const BatchRule& rule);

// Tasks of an array behind which more waits: enough that no slot idles before the next one is there; fewer
// are sooner done, and closed.
[[nodiscard]] std::size_t tasks_of_array(std::size_t slots);

// The time of a batch where nothing is known of its sectors, and each counts as one second. Where there are
// enough, each thread gets two: when the first has told what it took, the second goes on.
[[nodiscard]] double pilot_batch_s(std::size_t sectors, std::size_t slots, int threads);

// A task that takes `load_s` for its map should bake for longer, where nobody waits for it.
[[nodiscard]] double long_batch_s(double batch_s, double load_s, double most_s);
[[nodiscard]] double least_batch_s(double batch_s, double load_s);

}  // namespace drtv::executor
