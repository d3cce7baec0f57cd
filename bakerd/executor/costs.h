// What baking costs, as far as results have told.
#pragma once

#include "bakerd/worker/answers.h"

#include <cstdint>
#include <map>

namespace drtv::executor {

class Costs {
  public:
    // The same for all sectors of a map with the same settings.
    [[nodiscard]] static worker::Digest kind_of(const worker::BakeRequest& request);

    void learn(const worker::BakeRequest& request, const worker::TaskAnswer& answer);
    // A task that had so much memory had too little of it.
    void learn_too_little(const worker::BakeRequest& request, std::int64_t memory_bytes);

    // Of one thread, for a sector of that kind; 0: not known.
    [[nodiscard]] double seconds(const worker::Digest& kind) const;
    // That tasks needed of late before they could bake; 0: not known.
    [[nodiscard]] double load_seconds() const { return load_seconds_; }
    // That a task for this map should ask for; 0: not known.
    [[nodiscard]] std::int64_t memory_bytes(const worker::BakeRequest& request) const;

  private:
    std::map<worker::Digest, double> seconds_;            // by kind
    std::map<worker::Digest, std::int64_t> peak_memory_;  // by map
    double load_seconds_ = 0;
};

}  // namespace drtv::executor
