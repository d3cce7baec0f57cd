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

    [[nodiscard]] std::int64_t texels() const {
        return std::int64_t{high[0] - low[0]} * (high[1] - low[1]) * (high[2] - low[2]);
    }
    [[nodiscard]] bool empty() const { return low[0] >= high[0] || low[1] >= high[1] || low[2] >= high[2]; }
};

struct Volume::State {
    // Of the window's n-th texel along an axis: where its centre lies, and where it stands in a texture.
    struct Place {
        std::int32_t sector;  // i or j; of x and y alone
        std::int32_t cell;    // 0 to 15; likewise
        std::int32_t to;      // index in a texture
        std::int32_t copy;    // its copy at a border; -1: none
    };
    // A part of the window along x that lies over one sector and is not cut by the wrap.
    struct Run {
        std::int32_t x;   // of the window
        std::int32_t to;  // of the texture
        std::int32_t length;
        std::size_t under;  // sector along x, from the first
        bool whole_cells;   // texel after texel is cell after cell
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
        const std::uint8_t* cells_z = nullptr;         // [z], of its grid
        const std::uint8_t* outdoor_probes = nullptr;  // [p]; null: each for itself

        [[nodiscard]] std::size_t shown_probe(std::size_t p) const {
            return outdoor_probes == nullptr ? p : outdoor_probes[p];
        }
    };
    // Of which load, and which heights, a row of `cells_z` is.
    struct CellsOf {
        std::uint64_t load = 0;
        std::int32_t window_z = 0;
    };
    // Of which load and change a sector's encoded texels are.
    struct Encoded {
        std::uint64_t load = 0;
        std::uint64_t stamp = 0;
    };
    static constexpr std::size_t max_dirty = 256;

    State(const VolumeSettings& settings_, const SectorSetLimits& limits, std::span<std::byte> memory);
    // Without the state itself.
    [[nodiscard]] static std::size_t memory_bytes(const VolumeSettings& settings,
                                                  const SectorSetLimits& limits);

    VolumeSettings settings;
    std::span<std::byte> texels;
    std::span<std::byte> encoded;            // three texels per probe of the set
    std::span<Encoded> encoded_of;           // by slot
    std::array<std::span<Place>, 3> places;  // of the window's texels along each axis
    std::span<Under> under;                  // [j][i] from the south-western sector on
    std::span<std::uint8_t> cells_z;         // [i mod under_size[0], j mod under_size[1]][z]
    std::span<CellsOf> cells_of;             // likewise
    Int3 under_size{};                       // sectors along x and y that there is room for
    SectorId under_first;
    std::span<Shown> shown;   // by i mod under_size[0], j mod under_size[1]
    std::span<float> slices;  // of the blur
    std::span<Run> runs;      // of the box that is written
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
    // Of a sector in what stays from update to update.
    [[nodiscard]] std::size_t lasting_index(SectorId id) const;
    [[nodiscard]] const Place& place(std::size_t axis, std::int32_t n) const {
        return places[axis][static_cast<std::size_t>(n)];
    }
};

// Moves the window to a camera and writes what changed, or all.
void update_volume(Volume::State& state,
                   const SectorSet& set,
                   const RelitProbes& relit,
                   const Double3& camera_m,
                   bool write_all);

// Which sectors lie under the window, and where in them its columns do.
void look_under(Volume::State& state, const SectorSet& set, const RelitProbes& relit);

// Makes texels of the probes of all sectors under the window whose colours have changed.
void encode_probes(Volume::State& state, const RelitProbes& relit);

// Writes the texels of a box, with the copies at the borders.
void write_rows(Volume::State& state, const TexelBox& box);
void write_blurred(Volume::State& state, const RelitProbes& relit, const TexelBox& box);

// Colours of a place without a probe, by the tile of its sector.
[[nodiscard]] BasisColours fallback_at(const Volume::State& state,
                                       const Volume::State::Under& under,
                                       const Int3& place);

// What texture k's texels hold at the window's place (x, y, z), decoded; of rgba8_sqrt, the root of it over
// the scale.
[[nodiscard]] Float4 stored_texel(const Volume::State& state, std::size_t k, const Int3& place);

}  // namespace drtv
