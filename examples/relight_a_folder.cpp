// Loads a folder of sectors, flies over it through a day with a lamp, and says how long a frame's work takes.
//
//     relight_a_folder FOLDER
//
// SPDX-License-Identifier: MIT. Copy what you like.
#include <drtv/ambient.h>
#include <drtv/day.h>
#include <drtv/volume.h>

#include "sector_folder.h"

#include <chrono>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 2)
        return std::fputs("usage: relight_a_folder FOLDER\n", stderr), 1;

    // 1. Memory for everything, once: the same limits for all three. The runtime allocates nothing after
    // this.
    SectorFolder folder{argv[1]};
    const drtv::SectorSetLimits limits = folder.limits();
    const drtv::VolumeSettings settings{.encoding = drtv::TexelEncoding::rgba8_sqrt};
    std::vector<std::byte> set_memory(drtv::SectorSet::memory_bytes(limits));
    std::vector<std::byte> relit_memory(drtv::RelitProbes::memory_bytes(limits, false));
    std::vector<std::byte> volume_memory(drtv::Volume::memory_bytes(settings, limits));
    drtv::SectorSet set(set_memory, limits);
    drtv::RelitProbes relit(relit_memory, limits, false);
    drtv::Volume volume(volume_memory, settings, limits);

    // 2. The files.
    folder.load(set);
    const std::vector<const drtv::LoadedSector*>& sectors = folder.sectors;

    // 3. Frames: every two hours of a day, half a sector further east.
    const drtv::Day day = drtv::default_day();
    const double y = sectors.empty() ? 0 : 64.0 * sectors.front()->view.j + 32;
    double x = sectors.empty() ? 0 : 64.0 * sectors.front()->view.i;
    for (double hour = 0; hour < 24; hour += 2, x += 32) {
        const auto start = std::chrono::steady_clock::now();
        const drtv::Double3 camera = {x, y, 10};
        const drtv::SceneLight light = drtv::light_of_day(day, hour, drtv::RelightMode::accurate, {});

        // The lamp beside the camera: its bounce. Its direct light is the game's own.
        std::array<drtv::LightShare, drtv::max_shares_per_light> shares;
        const drtv::PointLight lamp{.position = {x + 2, y, 10}, .intensity = {20, 15, 8}};
        const std::span<const drtv::LightShare> lamps(shares.data(), drtv::split_light(set, lamp, shares));

        // All probes; a game does this when the light has changed enough, some sectors a frame.
        relit.set_light(drtv::Shown::now, light);
        float largest = relit.largest_fallback();
        for (const drtv::LoadedSector* sector : sectors) {
            relit.relight(drtv::Shown::now, *sector, light, lamps);
            largest = std::max(largest, relit.largest(*sector));
        }

        // The textures around the camera: upload volume.dirty() of volume.texels(0..2), set shader_inputs().
        volume.set_scale(drtv::suggest_scale(largest, volume.scale()));
        volume.update(set, relit, camera);
        const auto frame =
            std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start);

        // A particle at the camera is lit on the CPU, without the textures.
        const drtv::Ambient particle = drtv::ambient_at(set, light, lamps, {.at = camera});
        std::printf("%02.0f:00  %7.1f us, %zu boxes to upload, a particle gets (%.3f, %.3f, %.3f)\n",
                    hour,
                    frame.count(),
                    volume.dirty().size(),
                    static_cast<double>(particle.colour[0]),
                    static_cast<double>(particle.colour[1]),
                    static_cast<double>(particle.colour[2]));
    }
}
