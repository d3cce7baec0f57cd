// What a picture would be if the probes' colours were true: by path tracing at the probes.
#pragma once

#include "bakerd/picture/moment.h"
#include "bakerd/picture/path_light.h"
#include "bakerd/picture/show.h"

#include <glm/vec3.hpp>

#include <array>
#include <atomic>
#include <vector>

namespace drtv::picture {

// Two independent guesses at one thing.
template <class Value>
using Guesses = std::array<Value, 2>;

[[nodiscard]] inline glm::vec3 mean_of(const Guesses<glm::vec3>& guesses) {
    return (guesses[0] + guesses[1]) / 2.0f;
}

// Light at a unit normal by a mode's four weights. Of all ambient light nothing is below 0, as for the
// runtime; parts may be.
[[nodiscard]] Guesses<glm::vec3> shaded(RelightMode mode,
                                        Show shown,
                                        const Guesses<BasisColours>& colours,
                                        const glm::vec3& normal);

class TrueProbes {
  public:
    // `shown`: all ambient light, or a part of it. The others must outlive this.
    TrueProbes(const Moment& moment, const PathLight& path_light, Show shown);

    // Asks for the probes that light a place. Thread-safe.
    void ask_for(const glm::vec3& at, const glm::vec3& normal);
    // Traces those asked for.
    void trace();

    // What the runtime would find with true colours. Thread-safe. REQUIRES: asked for, and traced.
    [[nodiscard]] Guesses<glm::vec3> light(const glm::vec3& at, const glm::vec3& normal) const;

  private:
    const Moment& moment_;
    const PathLight& path_light_;
    const Show shown_;
    std::vector<std::atomic<const LoadedSector*>> sector_of_;  // by number of the probe; null: not asked for
    std::vector<Guesses<BasisColours>> colours_;               // likewise
};

}  // namespace drtv::picture
