#include "relit_volume.h"

#include "cli/report.h"
#include "sector_folder.h"

#include <algorithm>
#include <array>

namespace drtv::kit {

namespace {

template <class Has>
bool any_sector(const SectorSet& set, const Has& has) {
    bool any = false;
    for_each_sector(set, [&](const LoadedSector& sector) { any = any || has(sector.view); });
    return any;
}

}  // namespace

std::vector<LightShare> split_lamps(const SectorSet& set, std::span<const PointLight> lamps) {
    std::vector<LightShare> all;
    for (const PointLight& lamp : lamps) {
        std::array<LightShare, max_shares_per_light> shares;
        const std::size_t count = split_light(set, lamp, shares);
        all.insert(all.end(), shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return all;
}

void warn_of_lost_light(const SectorSet& set, const RequestedLight& requested, const std::string& where) {
    const std::string none = "none of the sectors " + where + " has ";
    for (const std::string& name : requested.names) {
        if (!any_sector(set,
                        [&](const SectorView& view) { return find_light_group(view, name).has_value(); }))
            cli::warn(none + "a light group \"" + name + "\"");
    }
    const auto takes_lamps = [](const SectorView& view) { return !view.local_receivers.empty(); };
    if (!requested.lamps.empty() && !any_sector(set, takes_lamps))
        cli::warn(none + "local transfer: lamps bring nothing");
}

TexelEncoding encoding_of(const std::string& name) {
    return name == "rgba8"        ? TexelEncoding::rgba8
           : name == "rgba8-sqrt" ? TexelEncoding::rgba8_sqrt
                                  : TexelEncoding::rgba16f;
}

RelitVolume::RelitVolume(const SectorSet& set,
                         const SceneLight& light,
                         std::span<const LightShare> lamps,
                         const VolumeSettings& settings)
    : set_(set),
      relit_memory_(RelitProbes::memory_bytes(set.limits(), false)),
      relit_(relit_memory_, set.limits(), false),
      volume_memory_(Volume::memory_bytes(settings, set.limits())),
      volume_(volume_memory_, settings, set.limits()) {
    relit_.set_light(Shown::now, light);
    float largest = relit_.largest_fallback();
    for_each_sector(set, [&](const LoadedSector& sector) {
        relit_.relight(Shown::now, sector, light, lamps);
        largest = std::max(largest, relit_.largest(sector));
    });
    volume_.set_scale(suggest_scale(largest, 0));
}

const Volume& RelitVolume::at(const Double3& camera) {
    volume_.update(set_, relit_, camera);
    return volume_;
}

}  // namespace drtv::kit
