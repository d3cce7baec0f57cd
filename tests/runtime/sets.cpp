#include "tests/runtime/sets.h"

#include <drtv/write.h>

#include <cstring>
#include <stdexcept>

namespace drtv::test {

OwnedSet::OwnedSet(const SectorSetLimits& limits)
    : memory_(SectorSet::memory_bytes(limits)), set_(std::make_unique<SectorSet>(memory_, limits)) {}

const LoadedSector& OwnedSet::add(const Sector& sector) {
    files_.push_back(std::make_unique<std::vector<std::uint8_t>>(write_sector(sector)));
    const LoadedSector* loaded = nullptr;
    ReadStatus why;
    if (set_->load(*files_.back(), &loaded, &why) != LoadStatus::loaded)
        throw std::runtime_error("not loaded: " + why.message);
    return *loaded;
}

OwnedRelit::OwnedRelit(const SectorSetLimits& limits, bool with_fade)
    : memory_(RelitProbes::memory_bytes(limits, with_fade)),
      relit_(std::make_unique<RelitProbes>(memory_, limits, with_fade)) {}

OwnedVolume::OwnedVolume(const VolumeSettings& settings, const SectorSetLimits& limits, int poison)
    : memory_(Volume::memory_bytes(settings, limits), static_cast<std::byte>(poison)),
      volume_(std::make_unique<Volume>(memory_, settings, limits)) {
    for (std::size_t k = 0; k < channel_count; ++k) {
        const auto texels = volume_->texels(k);
        std::memset(const_cast<std::byte*>(texels.data()), poison, texels.size());
    }
}

Sector lattice_sector(SectorId id, std::size_t side, double height_m) {
    Sector sector;
    sector.i = id.i;
    sector.j = id.j;
    sector.bake.rays = 1;
    sector.bake.bounces = 1;
    sector.bake.reach_m = 100;
    sector.bake.min_distance_m = 4;
    constexpr std::size_t units = sector_size_m * position_units_per_m;
    const std::size_t step = units / side;
    const auto height = static_cast<std::uint16_t>(height_m * position_units_per_m);
    for (std::size_t y = 0; y < side; ++y) {
        for (std::size_t x = 0; x < side; ++x) {
            Probe probe;
            probe.position = {static_cast<std::uint16_t>(step * x + step / 2),
                              static_cast<std::uint16_t>(step * y + step / 2), height};
            probe.sky_visibility = {32767, 32767, 32767, 0};
            sector.probes.push_back(probe);
        }
    }
    sector.grid.z_origin_units = 0;
    sector.grid.cell_height_units = position_units_per_m;
    const std::size_t cells = grid_size / side;
    for (std::size_t n = 0; n < grid_cell_count; ++n) {
        const std::size_t x = n % grid_size / cells;
        const std::size_t y = n / grid_size % grid_size / cells;
        sector.grid.cells[n] = static_cast<std::uint8_t>(x + side * y);
    }
    return sector;
}

void put_on_plane(Sector& sector, const Float3& albedo) {
    for (Probe& probe : sector.probes) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                const float down = albedo[c] * (1 - transfer_basis[b][2]) / 2;
                probe.transfer[c][b] = {encode_fixed(down * sh_y0, transfer_scale), 0,
                                        encode_fixed(down * sh_y1 * 2 / 3, transfer_scale), 0};
            }
        }
    }
}

}  // namespace drtv::test
