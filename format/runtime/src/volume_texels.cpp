// From relit probes to texels of each probe, and back from texels to colours.
#include "volume_texels.h"
#include "columns.h"

#include <drtv/sky_tile.h>

#include <array>
#include <cmath>
#include <cstring>

namespace drtv {
namespace {

template <class Texel>
void encode_sectors(Volume::State& state, const RelitProbes& relit) {
    const Encoder encoder = encoder_of(state);
    const auto texels = encoded_probes<Texel>(state);
    for (const Volume::State::Under& under : state.under) {
        if (under.sector == nullptr)
            continue;
        const LoadedSector& sector = *under.sector;
        Volume::State::Encoded& encoded = state.encoded_of[sector.slot];
        const std::uint64_t stamp = relit.stamp(sector);
        if (encoded.load == sector.load && encoded.stamp == stamp)
            continue;
        for (std::size_t p = 0; p < sector.view.probe_count; ++p) {
            const BasisColours colours = relit.colours(sector, under.shown_probe(p));
            texels[sector.first_probe + p] = encoder.encode<Texel>(texel_colours(colours));
        }
        encoded = {sector.load, stamp};
    }
}

std::int32_t floor_div16(std::int64_t column) {
    return static_cast<std::int32_t>(column >> 4);
}

}  // namespace

// Colours of places without a probe, by the tile of their sector.
BasisColours fallback_at(const Volume::State& state, const Volume::State::Under& under, const Int3& place) {
    BasisColours colours = state.fallback;
    if (under.tile == nullptr)
        return colours;
    const std::size_t x = static_cast<std::size_t>(state.places[0][static_cast<std::size_t>(place[0])].cell);
    const std::size_t y = static_cast<std::size_t>(state.places[1][static_cast<std::size_t>(place[1])].cell);
    const float factor = sky_factor(*under.tile, x, y, state.centre_m(2, place[2]));
    for (Float3& colour : colours) {
        for (float& channel : colour)
            channel *= factor;
    }
    return colours;
}

void look_under(Volume::State& state, const SectorSet& set, const RelitProbes& relit) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t size = state.settings.size[axis];
        const std::int32_t border = state.border();
        std::int32_t to = state.wrapped(axis, 0) - border;
        for (std::int32_t n = 0; n < size; ++n) {
            const auto column = static_cast<std::int64_t>(std::floor(state.centre_m(axis, n) / cell_m));
            const bool has_copy = border == 1 && (to == 0 || to == size - 1);
            const std::int32_t copy = to == 0 ? size + 1 : 0;
            state.places[axis][static_cast<std::size_t>(n)] = {floor_div16(column),
                                                               static_cast<std::int32_t>(column & 15),
                                                               to + border,
                                                               has_copy ? copy : -1};
            to = to + 1 == size ? 0 : to + 1;
        }
    }
    state.under_first = {state.places[0].front().sector, state.places[1].front().sector};
    const auto size_z = static_cast<std::size_t>(state.settings.size[2]);
    for (std::size_t n = 0; n < state.under.size(); ++n) {
        const auto across = static_cast<std::size_t>(state.under_size[0]);
        Volume::State::Under& under = state.under[n];
        under.id = {state.under_first.i + static_cast<std::int32_t>(n % across),
                    state.under_first.j + static_cast<std::int32_t>(n / across)};
        under.tile = set.tile(under.id);
        const LoadedSector* sector = set.find(under.id);
        under.sector = sector != nullptr && relit.is_relit(*sector) ? sector : nullptr;
        if (under.sector == nullptr)
            continue;
        under.outdoor_probes = state.settings.outdoors ? set.outdoor_probes(*sector).data() : nullptr;
        const std::size_t lasting = state.lasting_index(under.id);
        Volume::State::CellsOf& of = state.cells_of[lasting];
        std::uint8_t* cells = state.cells_z.data() + lasting * size_z;
        under.cells_z = cells;
        if (of.load == sector->load && of.window_z == state.window[2])
            continue;
        of = {sector->load, state.window[2]};
        const StoredGrid& grid = *sector->view.grid;
        for (std::size_t z = 0; z < size_z; ++z) {
            const double units =
                state.centre_m(2, static_cast<std::int32_t>(z)) * position_units_per_m - grid.z_origin_units;
            const double cell = std::clamp(units / grid.cell_height_units, 0.0, double{grid_size - 1});
            cells[z] = static_cast<std::uint8_t>(cell);
        }
    }
}

void encode_probes(Volume::State& state, const RelitProbes& relit) {
    if (state.settings.encoding == TexelEncoding::rgba16f)
        encode_sectors<std::uint64_t>(state, relit);
    else
        encode_sectors<std::uint32_t>(state, relit);
}

Float4 stored_texel(const Volume::State& state, std::size_t k, const Int3& place) {
    const Int3 size = state.texture_size();
    const std::size_t at =
        offset_in(size, state.wrapped(0, place[0]), state.wrapped(1, place[1]), state.wrapped(2, place[2]));
    Float4 texel{};
    if (state.settings.encoding == TexelEncoding::rgba16f) {
        std::array<std::uint16_t, 4> halves;
        std::memcpy(halves.data(), texture<std::uint64_t>(state, k) + at, sizeof halves);
        for (std::size_t c = 0; c < 4; ++c)
            texel[c] = float_of_half(halves[c]);
        return texel;
    }
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), texture<std::uint32_t>(state, k) + at, sizeof bytes);
    const float scale = state.settings.encoding == TexelEncoding::rgba8 ? state.scale : 1;
    for (std::size_t c = 0; c < 4; ++c)
        texel[c] = static_cast<float>(bytes[c]) / code_max * scale;
    return texel;
}

}  // namespace drtv
