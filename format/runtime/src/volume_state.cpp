#include "volume_state.h"

#include "arena.h"
#include "columns.h"

#include <algorithm>
#include <cmath>

namespace drtv {
namespace {

// Sectors that texels along one axis may lie over, wherever the window starts.
std::int32_t sectors_under(const VolumeSettings& settings, std::size_t axis) {
    const double length_m =
        static_cast<double>(settings.size[axis]) * static_cast<double>(settings.texel_m[axis]);
    return static_cast<std::int32_t>(std::ceil(length_m / side_m)) + 1;
}

std::size_t product(const Int3& size) {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
}

Int3 texture_size_of(const VolumeSettings& settings) {
    const std::int32_t more = settings.borders ? 2 : 0;
    return {settings.size[0] + more, settings.size[1] + more, settings.size[2] + more};
}

struct Counts {
    std::size_t texel_bytes;
    std::size_t encoded_bytes;
    std::size_t slots;
    std::array<std::size_t, 3> places;
    std::size_t under;
    std::size_t cells_z;
    std::size_t slices;
    std::size_t runs;
};

Counts counts_of(const VolumeSettings& settings, const SectorSetLimits& limits) {
    const std::size_t texel = settings.encoding == TexelEncoding::rgba16f ? 8 : 4;
    const auto under = static_cast<std::size_t>(sectors_under(settings, 0)) *
                       static_cast<std::size_t>(sectors_under(settings, 1));
    const auto nx = static_cast<std::size_t>(settings.size[0]);
    const auto ny = static_cast<std::size_t>(settings.size[1]);
    constexpr std::size_t floats = basis_count * channel_count;
    // A slice with a texel more on each side, one that is blurred along x, and three along both.
    const std::size_t slices = (nx + 2) * (ny + 2) + nx * (ny + 2) + 3 * nx * ny;
    return {channel_count * texel * product(texture_size_of(settings)),
            channel_count * texel * limits.probes,
            limits.sectors,
            {nx, ny, static_cast<std::size_t>(settings.size[2])},
            under,
            under * static_cast<std::size_t>(settings.size[2]),
            settings.blur ? slices * floats : 0,
            static_cast<std::size_t>(sectors_under(settings, 0)) + 2};
}

}  // namespace

Int3 Volume::State::texture_size() const {
    return texture_size_of(settings);
}

std::size_t Volume::State::texels_per_texture() const {
    return product(texture_size());
}

std::int32_t Volume::State::wrapped(std::size_t axis, std::int32_t n) const {
    return modulo(window[axis] + n, settings.size[axis]) + border();
}

double Volume::State::centre_m(std::size_t axis, std::int32_t n) const {
    return (static_cast<double>(window[axis] + n) + 0.5) * static_cast<double>(settings.texel_m[axis]);
}

std::size_t Volume::State::under_index(std::int32_t x, std::int32_t y) const {
    const std::int32_t i = places[0][static_cast<std::size_t>(x)].sector - under_first.i;
    const std::int32_t j = places[1][static_cast<std::size_t>(y)].sector - under_first.j;
    return static_cast<std::size_t>(j * under_size[0] + i);
}

std::size_t Volume::State::lasting_index(SectorId id) const {
    const std::int32_t i = modulo(id.i, under_size[0]);
    const std::int32_t j = modulo(id.j, under_size[1]);
    return static_cast<std::size_t>(j * under_size[0] + i);
}

std::size_t Volume::State::memory_bytes(const VolumeSettings& settings, const SectorSetLimits& limits) {
    const Counts counts = counts_of(settings, limits);
    return Arena::bytes_of<std::byte>(counts.texel_bytes) + Arena::bytes_of<std::byte>(counts.encoded_bytes) +
           Arena::bytes_of<Encoded>(counts.slots) + Arena::bytes_of<Place>(counts.places[0]) +
           Arena::bytes_of<Place>(counts.places[1]) + Arena::bytes_of<Place>(counts.places[2]) +
           Arena::bytes_of<CellsOf>(counts.under) + Arena::bytes_of<Under>(counts.under) +
           Arena::bytes_of<std::uint8_t>(counts.cells_z) + Arena::bytes_of<Shown>(counts.under) +
           Arena::bytes_of<float>(counts.slices) + Arena::bytes_of<Run>(counts.runs);
}

Volume::State::State(const VolumeSettings& settings_,
                     const SectorSetLimits& limits,
                     std::span<std::byte> memory)
    : settings(settings_), under_size{sectors_under(settings_, 0), sectors_under(settings_, 1), 1} {
    const Counts counts = counts_of(settings, limits);
    Arena arena(memory);
    texels = arena.take<std::byte>(counts.texel_bytes);
    encoded = arena.take<std::byte>(counts.encoded_bytes);
    encoded_of = arena.take<Encoded>(counts.slots);
    places = {arena.take<Place>(counts.places[0]),
              arena.take<Place>(counts.places[1]),
              arena.take<Place>(counts.places[2])};
    under = arena.take<Under>(counts.under);
    cells_z = arena.take<std::uint8_t>(counts.cells_z);
    cells_of = arena.take<CellsOf>(counts.under);
    shown = arena.take<Shown>(counts.under);
    slices = arena.take<float>(counts.slices);
    runs = arena.take<Run>(counts.runs);
}

}  // namespace drtv
