// What a volume is made of, and the parts of its work.
#pragma once

#include <drtv/volume.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drtv {

using Int3 = std::array<std::int32_t, 3>;

// Texels of the window, counted from its lowest; `high` is behind the last.
struct TexelBox {
    Int3 low{};
    Int3 high{};

    [[nodiscard]] bool empty() const { return low[0] >= high[0] || low[1] >= high[1] || low[2] >= high[2]; }
};

struct Volume::State {
    // Where the centres of texels lie along x or y.
    struct Place {
        std::int32_t sector;  // i or j
        std::int32_t cell;    // 0 to 15
    };
    // What a sector's place showed when it was written.
    struct Shown {
        SectorId id;
        std::uint64_t load = 0;  // 0: no relit sector
        std::uint64_t stamp = 0;
        const SkyTile* tile = nullptr;

        bool operator==(const Shown&) const = default;
    };
    // A sector under the window, while it is written.
    struct Under {
        SectorId id;
        const LoadedSector* sector = nullptr;  // null: the fallback
        const SkyTile* tile = nullptr;
    };
    // Of which load and change a sector's encoded texels are.
    struct Encoded {
        std::uint64_t load = 0;
        std::uint64_t stamp = 0;
    };
    static constexpr std::size_t max_dirty = 256;

    State(const VolumeSettings& settings_, const SectorSetLimits& limits, std::span<std::byte> memory);
    // Without the state itself.
    [[nodiscard]] static std::size_t memory_bytes(const VolumeSettings& settings, const SectorSetLimits& limits);

    VolumeSettings settings;
    std::span<std::byte> texels;
    std::span<std::byte> encoded;          // three texels per probe of the set
    std::span<Encoded> encoded_of;         // by slot
    std::array<std::span<Place>, 2> places;  // of the window's columns along x and y
    std::span<Under> under;                // [j][i] from the south-western sector on
    std::span<std::uint8_t> cells_z;       // [sector under the window][z]
    Int3 under_size{};                     // sectors along x and y that there is room for
    SectorId under_first;
    std::span<Shown> shown;  // by i mod under_size[0], j mod under_size[1]
    std::span<float> slices;  // of the blur
    BasisColours fallback{};
    Int3 window{};
    bool filled = false;
    bool stale = false;  // all of it is to be written again
    float scale = 1;
    std::array<TextureBox, max_dirty> dirty;
    std::size_t dirty_count = 0;

    [[nodiscard]] TexelBox whole() const { return {{0, 0, 0}, settings.size}; }
    [[nodiscard]] std::int32_t border() const { return settings.borders ? 1 : 0; }
    // Of one texture, or of a third of the atlas.
    [[nodiscard]] Int3 texture_size() const;
    [[nodiscard]] std::size_t texels_per_texture() const;
    // Index along an axis of a texture, of the window's n-th texel.
    [[nodiscard]] std::int32_t wrapped(std::size_t axis, std::int32_t n) const;
    [[nodiscard]] double centre_m(std::size_t axis, std::int32_t n) const;
    // REQUIRES: the places are those of the window.
    [[nodiscard]] std::size_t under_index(std::int32_t x, std::int32_t y) const;
};

// Which sectors lie under the window, and where in them its columns do.
void look_under(Volume::State& state, const SectorSet& set, const RelitProbes& relit);

// Makes texels of the probes of all sectors under the window whose colours have changed.
void encode_probes(Volume::State& state, const RelitProbes& relit);

// Writes the texels of a box, with the copies at the borders.
void write_box(Volume::State& state, const RelitProbes& relit, const TexelBox& box);

// A texel as the textures hold it: [k][r, g, b, a].
using TexelColours = std::array<Float4, channel_count>;
// What texture k's texels hold at the window's place (x, y, z), decoded; of rgba8_sqrt, the root of it over the scale.
[[nodiscard]] Float4 stored_texel(const Volume::State& state, std::size_t k, const Int3& place);

}  // namespace drtv
