// CPU and GPU share one set of volume textures, without a second to write meanwhile (slide 59 of the talk):
// the G-buffer pass needs none of it, so the CPU updates it in that time. A thread stands for the GPU.
//
//     one_set_of_textures FOLDER
//
// SPDX-License-Identifier: MIT. Copy what you like.
#include <drtv/day.h>
#include <drtv/volume.h>

#include "sector_folder.h"

#include <chrono>
#include <cstdio>
#include <semaphore>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration time) {
    return std::chrono::duration<double, std::micro>(time).count();
}

// The day goes on in steps of half an hour: some sectors are relit in each frame, then what is shown fades
// from one step to the next, so that never half of the volume is old and half new.
class LightOfDay {
  public:
    LightOfDay(const std::vector<const drtv::LoadedSector*>& sectors, drtv::RelitProbes& relit)
        : sectors_(sectors), relit_(relit) {
        start(drtv::Shown::now, 6);
        for (const drtv::LoadedSector* sector : sectors_)
            relit_.relight(drtv::Shown::now, *sector, light_, {});
        start(drtv::Shown::next, 6.5);
    }

    void advance() {
        constexpr std::size_t sectors_per_frame = 8;
        for (std::size_t n = 0; n < sectors_per_frame && done_ < sectors_.size(); ++n)
            relit_.relight(drtv::Shown::next, *sectors_[done_++], light_, {});
        if (done_ < sectors_.size())
            return;
        relit_.set_fade(relit_.fade() + 0.125f);
        if (relit_.fade() < 1)
            return;
        relit_.finish_fade();
        start(drtv::Shown::next, hour_ + 0.5);
    }

    [[nodiscard]] double hour() const { return hour_; }

  private:
    void start(drtv::Shown shown, double hour) {
        hour_ = hour;
        done_ = 0;
        light_ = drtv::light_of_day(day_, hour, drtv::RelightMode::accurate, {});
        relit_.set_light(shown, light_);
    }

    const drtv::Day day_ = drtv::default_day();
    const std::vector<const drtv::LoadedSector*>& sectors_;
    drtv::RelitProbes& relit_;
    drtv::SceneLight light_;
    double hour_ = 0;
    std::size_t done_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2)
        return std::fputs("usage: one_set_of_textures FOLDER\n", stderr), 1;
    SectorFolder folder{argv[1]};
    const drtv::SectorSetLimits limits = folder.limits();
    const drtv::VolumeSettings settings{.encoding = drtv::TexelEncoding::rgba8_sqrt};
    std::vector<std::byte> set_memory(drtv::SectorSet::memory_bytes(limits));
    std::vector<std::byte> relit_memory(drtv::RelitProbes::memory_bytes(limits, true));
    std::vector<std::byte> volume_memory(drtv::Volume::memory_bytes(settings, limits));
    drtv::SectorSet set(set_memory, limits);
    drtv::RelitProbes relit(relit_memory, limits, true);
    drtv::Volume volume(volume_memory, settings, limits);
    folder.load(set);
    LightOfDay light(folder.sectors, relit);
    volume.set_scale(32);

    // The GPU starts the CPU's work at the beginning of its frame, and waits for it where it first reads.
    std::binary_semaphore textures_are_free(0);
    std::binary_semaphore textures_are_ready(0);
    constexpr int frames = 120;
    double waited = 0;
    unsigned long long seen = 0;
    std::thread gpu([&] {
        for (int frame = 0; frame < frames; ++frame) {
            textures_are_free.release();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the G-buffer pass, and SSAO
            const Clock::time_point at_ambient = Clock::now();
            textures_are_ready.acquire();
            waited += microseconds(Clock::now() - at_ambient);
            for (std::size_t k = 0; k < 3; ++k) {  // the ambient pass reads
                for (const std::byte texel : volume.texels(k))
                    seen += std::to_integer<unsigned>(texel);
            }
        }
    });

    // The CPU's frame: everything that writes lies between the two semaphores.
    const double x = folder.sectors.empty() ? 0 : 64.0 * folder.sectors.front()->view.i;
    const double y = folder.sectors.empty() ? 0 : 64.0 * folder.sectors.front()->view.j + 32;
    double worked = 0;
    for (int frame = 0; frame < frames; ++frame) {
        textures_are_free.acquire();
        const Clock::time_point start = Clock::now();
        light.advance();
        volume.update(set, relit, {x + frame, y, 10});
        worked += microseconds(Clock::now() - start);
        textures_are_ready.release();
    }
    gpu.join();
    std::printf(
        "%d frames until %.1f h: the CPU worked %.0f us a frame, the GPU waited %.0f us, and saw %llu\n",
        frames,
        light.hour(),
        worked / frames,
        waited / frames,
        seen);
}
