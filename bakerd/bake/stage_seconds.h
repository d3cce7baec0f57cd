// Where the time of a sector's bake went.
#pragma once

#include <chrono>

namespace drtv::bake {

// Wall time of each stage, in seconds, while other sectors were baked beside it.
struct StageSeconds {
    double scene = 0;           // building what its rays meet; neighbours share it
    double placement = 0;       // of its probes; with local transfer its neighbours wait for theirs
    double transfer = 0;        // the probes' paths, and the grid beside them
    double local_transfer = 0;  // local radiance transfer
    double files = 0;           // all else: reading earlier results, encoding, writing

    [[nodiscard]] double total() const { return scene + placement + transfer + local_transfer + files; }
    StageSeconds& operator+=(const StageSeconds& more) {
        scene += more.scene;
        placement += more.placement;
        transfer += more.transfer;
        local_transfer += more.local_transfer;
        files += more.files;
        return *this;
    }
    bool operator==(const StageSeconds&) const = default;
};

// Each with the name it has in messages and in the database.
void visit_values(auto& codec, auto& stages) {
    codec("scene_s", stages.scene);
    codec("placement_s", stages.placement);
    codec("transfer_s", stages.transfer);
    codec("local_transfer_s", stages.local_transfer);
    codec("files_s", stages.files);
}

class Stopwatch {
  public:
    // Seconds since the last lap, or since the start.
    double lap() {
        const Clock::time_point now = Clock::now();
        const std::chrono::duration<double> passed = now - last_;
        last_ = now;
        return passed.count();
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point last_ = Clock::now();
};

}  // namespace drtv::bake
