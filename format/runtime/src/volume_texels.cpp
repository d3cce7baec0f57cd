// From relit probes to the texels of a volume.
#include "half.h"
#include "volume_state.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace drtv {
namespace {

constexpr std::size_t texture_count = channel_count;
constexpr float code_max = 255;

template <class Texel>
using ProbeTexels = std::array<Texel, texture_count>;

// Not below 0, in codes.
std::uint32_t code_of(float codes) {
    return codes < code_max ? static_cast<std::uint32_t>(codes + 0.5f) : static_cast<std::uint32_t>(code_max);
}

struct Encoder {
    TexelEncoding encoding;
    float per_scale;  // 1 / scale

    [[nodiscard]] std::uint8_t byte_of(float x) const {
        const float share = x * per_scale;
        const float shaped = encoding == TexelEncoding::rgba8_sqrt ? std::sqrt(share) : share;
        return static_cast<std::uint8_t>(code_of(shaped * code_max));
    }
    void encode(const Float4& colour, std::uint32_t& texel) const {
        const std::array<std::uint8_t, 4> bytes = {
            byte_of(colour[0]), byte_of(colour[1]), byte_of(colour[2]), byte_of(colour[3])};
        std::memcpy(&texel, bytes.data(), sizeof texel);
    }
    void encode(const Float4& colour, std::uint64_t& texel) const {
        const std::array<std::uint16_t, 4> halves = {
            half_of(colour[0]), half_of(colour[1]), half_of(colour[2]), half_of(colour[3])};
        std::memcpy(&texel, halves.data(), sizeof texel);
    }

    template <class Texel>
    [[nodiscard]] ProbeTexels<Texel> encode(const TexelColours& colours) const {
        ProbeTexels<Texel> texels;
        for (std::size_t k = 0; k < texture_count; ++k)
            encode(colours[k], texels[k]);
        return texels;
    }
};

Encoder encoder_of(const Volume::State& state) {
    return {state.settings.encoding, 1 / state.scale};
}

TexelColours texel_colours(const BasisColours& colours) {
    TexelColours texels;
    for (std::size_t k = 0; k < texture_count; ++k)
        texels[k] = {colours[k][0], colours[k][1], colours[k][2], colours[3][k]};
    return texels;
}

template <class Texel>
std::span<ProbeTexels<Texel>> encoded_probes(const Volume::State& state) {
    auto* first = reinterpret_cast<ProbeTexels<Texel>*>(state.encoded.data());
    return {first, state.encoded.size() / sizeof(ProbeTexels<Texel>)};
}

template <class Texel>
Texel* texture(const Volume::State& state, std::size_t k) {
    return reinterpret_cast<Texel*>(state.texels.data()) + k * state.texels_per_texture();
}

std::size_t offset_in(const Int3& size, std::int32_t x, std::int32_t y, std::int32_t z) {
    const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y);
    return row * static_cast<std::size_t>(size[0]) + static_cast<std::size_t>(x);
}

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
        for (std::size_t p = 0; p < sector.view.probe_count; ++p)
            texels[sector.first_probe + p] =
                encoder.encode<Texel>(texel_colours(relit.colours(sector, p)));
        encoded = {sector.load, stamp};
    }
}

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

// Writes the row of the window at (y, z) from x0 to x1 to three rows of texels, where x is wrapped.
template <class Texel>
class RowWriter {
  public:
    explicit RowWriter(const Volume::State& state)
        : state_(state),
          encoder_(encoder_of(state)),
          probes_(encoded_probes<Texel>(state)),
          open_(encoder_.encode<Texel>(texel_colours(state.fallback))) {}

    void write(const std::array<Texel*, texture_count>& rows, std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z) const {
        const auto& places = state_.places[0];
        const std::int32_t size = state_.settings.size[0];
        for (std::int32_t x = x0; x < x1;) {
            // As far as one sector goes, and as the texture does before it wraps.
            const std::int32_t to = state_.wrapped(0, x);
            const std::int32_t until_wrap = size + state_.border() - to;
            const std::int32_t sector = places[static_cast<std::size_t>(x)].sector;
            std::int32_t end = x + 1;
            while (end < x1 && end - x < until_wrap && places[static_cast<std::size_t>(end)].sector == sector)
                ++end;
            write_run(rows, to, x, end, y, z);
            x = end;
        }
    }

  private:
    void write_run(const std::array<Texel*, texture_count>& rows,
                   std::int32_t to,
                   std::int32_t x,
                   std::int32_t end,
                   std::int32_t y,
                   std::int32_t z) const {
        const std::size_t index = state_.under_index(x, y);
        const Volume::State::Under& under = state_.under[index];
        const std::uint8_t* cells = nullptr;
        const ProbeTexels<Texel>* probes = nullptr;
        std::size_t count = 0;
        if (under.sector != nullptr) {
            const std::size_t cell_z = state_.cells_z[index * static_cast<std::size_t>(state_.settings.size[2]) +
                                                      static_cast<std::size_t>(z)];
            const auto cell_y = static_cast<std::size_t>(state_.places[1][static_cast<std::size_t>(y)].cell);
            cells = under.sector->view.grid->cells.data() + grid_size * (cell_y + grid_size * cell_z);
            probes = probes_.data() + under.sector->first_probe;
            count = under.sector->view.probe_count;
        }
        const Volume::State::Place* place = &state_.places[0][static_cast<std::size_t>(x)];
        for (std::int32_t n = 0; n < end - x; ++n) {
            const std::size_t p = cells == nullptr ? no_probe : cells[place[n].cell];
            const ProbeTexels<Texel>* texels = &open_;
            ProbeTexels<Texel> darkened;
            if (p < count) {
                texels = &probes[p];
            } else if (under.tile != nullptr) {
                darkened = encoder_.encode<Texel>(texel_colours(fallback_at(state_, under, {x + n, y, z})));
                texels = &darkened;
            }
            for (std::size_t k = 0; k < texture_count; ++k)
                rows[k][to + n] = (*texels)[k];
        }
    }

    const Volume::State& state_;
    Encoder encoder_;
    std::span<const ProbeTexels<Texel>> probes_;
    ProbeTexels<Texel> open_;
};

// Copies of what a row, or a slice, holds at its ends, to the borders.
struct Copies {
    std::array<std::int32_t, 2> to;
    std::size_t count = 0;
};

// Where else in a texture of `length` texels and borders index `at` stands.
Copies copies_of(const Volume::State& state, std::size_t axis, std::int32_t at) {
    const std::int32_t length = state.settings.size[axis];
    Copies copies{};
    if (state.border() == 0)
        return copies;
    if (at == 1)
        copies.to[copies.count++] = length + 1;
    if (at == length)
        copies.to[copies.count++] = 0;
    return copies;
}

// Copies the texels that the box has in the row (y, z) to the borders along all axes.
template <class Texel>
void copy_to_borders(const Volume::State& state, Texel* base, std::int32_t x0, std::int32_t x1, std::int32_t ty, std::int32_t tz) {
    const Int3 size = state.texture_size();
    const std::int32_t length = state.settings.size[0];
    Texel* row = base + offset_in(size, 0, ty, tz);
    if (state.border() == 1) {
        // Cheap, and right too where the box has neither of them.
        row[0] = row[length];
        row[length + 1] = row[1];
    }
    const Copies to_y = copies_of(state, 1, ty);
    const Copies to_z = copies_of(state, 2, tz);
    const auto copy = [&](std::int32_t y, std::int32_t z) {
        Texel* to = base + offset_in(size, 0, y, z);
        const std::int32_t first = state.wrapped(0, x0);
        const std::int32_t count = std::min(x1 - x0, length);
        const std::int32_t behind = std::min(first + count, length + 1);
        const auto bytes = [](std::int32_t n) { return static_cast<std::size_t>(n) * sizeof(Texel); };
        std::memcpy(to + first, row + first, bytes(behind - first));
        const std::int32_t rest = count - (behind - first);
        std::memcpy(to + 1, row + 1, bytes(rest));
        to[0] = row[0];
        to[length + 1] = row[length + 1];
    };
    for (std::size_t y = 0; y < to_y.count; ++y)
        copy(to_y.to[y], tz);
    for (std::size_t z = 0; z < to_z.count; ++z) {
        copy(ty, to_z.to[z]);
        for (std::size_t y = 0; y < to_y.count; ++y)
            copy(to_y.to[y], to_z.to[z]);
    }
}

template <class Texel>
void write_plain(const Volume::State& state, const TexelBox& box) {
    const RowWriter<Texel> writer(state);
    const Int3 size = state.texture_size();
    for (std::int32_t z = box.low[2]; z < box.high[2]; ++z) {
        const std::int32_t tz = state.wrapped(2, z);
        for (std::int32_t y = box.low[1]; y < box.high[1]; ++y) {
            const std::int32_t ty = state.wrapped(1, y);
            std::array<Texel*, texture_count> rows;
            for (std::size_t k = 0; k < texture_count; ++k)
                rows[k] = texture<Texel>(state, k) + offset_in(size, 0, ty, tz);
            writer.write(rows, box.low[0], box.high[0], y, z);
            for (std::size_t k = 0; k < texture_count; ++k)
                copy_to_borders(state, texture<Texel>(state, k), box.low[0], box.high[0], ty, tz);
        }
    }
}

// ---- Blur: separable, slice by slice, on linear colours.

constexpr std::size_t floats_per_texel = basis_count * channel_count;

BasisColours colours_of(const Volume::State& state, const RelitProbes& relit, const Int3& place) {
    const std::size_t index = state.under_index(place[0], place[1]);
    const Volume::State::Under& under = state.under[index];
    if (under.sector == nullptr)
        return fallback_at(state, under, place);
    const std::size_t cell_x = static_cast<std::size_t>(state.places[0][static_cast<std::size_t>(place[0])].cell);
    const std::size_t cell_y = static_cast<std::size_t>(state.places[1][static_cast<std::size_t>(place[1])].cell);
    const std::size_t cell_z = state.cells_z[index * static_cast<std::size_t>(state.settings.size[2]) +
                                             static_cast<std::size_t>(place[2])];
    const std::uint8_t p =
        under.sector->view.grid->cells[cell_x + grid_size * (cell_y + grid_size * cell_z)];
    if (p >= under.sector->view.probe_count)
        return fallback_at(state, under, place);
    return relit.colours(*under.sector, p);
}

void store_texel(const BasisColours& colours, float* to) {
    const TexelColours texels = texel_colours(colours);
    for (const Float4& texel : texels)
        to = std::copy(texel.begin(), texel.end(), to);
}

void blur(const float* before, const float* middle, const float* after, float* to) {
    for (std::size_t n = 0; n < floats_per_texel; ++n)
        to[n] = ((before[n] + after[n]) + 2 * middle[n]) * 0.25f;
}

// The slices of a box that a blur goes through. A slice stands [y][x][floats_per_texel].
class SliceBlur {
  public:
    SliceBlur(const Volume::State& state, const RelitProbes& relit, const TexelBox& box)
        : state_(state),
          relit_(relit),
          box_(box),
          width_(static_cast<std::size_t>(box.high[0] - box.low[0])),
          height_(static_cast<std::size_t>(box.high[1] - box.low[1])) {
        float* next = state.slices.data();
        const auto take = [&](std::size_t texels) {
            float* first = next;
            next += texels * floats_per_texel;
            return first;
        };
        raw_ = take((width_ + 2) * (height_ + 2));
        along_x_ = take(width_ * (height_ + 2));
        for (float*& slice : flat_)
            slice = take(width_ * height_);
    }

    // The slice at z of the window, blurred along x and y. It stays for three slices.
    [[nodiscard]] const float* flat(std::int32_t z) {
        const std::int32_t within = std::clamp(z, 0, state_.settings.size[2] - 1);
        const auto slot = static_cast<std::size_t>(within % 3);
        if (held_[slot] != within) {
            make(within, flat_[slot]);
            held_[slot] = within;
        }
        return flat_[slot];
    }

  private:
    void make(std::int32_t z, float* to) {
        const Int3& size = state_.settings.size;
        for (std::size_t y = 0; y < height_ + 2; ++y) {
            for (std::size_t x = 0; x < width_ + 2; ++x) {
                const std::int32_t at_x = std::clamp(box_.low[0] + static_cast<std::int32_t>(x) - 1, 0, size[0] - 1);
                const std::int32_t at_y = std::clamp(box_.low[1] + static_cast<std::int32_t>(y) - 1, 0, size[1] - 1);
                store_texel(colours_of(state_, relit_, {at_x, at_y, z}), at(raw_, width_ + 2, x, y));
            }
            for (std::size_t x = 0; x < width_; ++x)
                blur(at(raw_, width_ + 2, x, y),
                     at(raw_, width_ + 2, x + 1, y),
                     at(raw_, width_ + 2, x + 2, y),
                     at(along_x_, width_, x, y));
        }
        for (std::size_t y = 0; y < height_; ++y) {
            for (std::size_t x = 0; x < width_; ++x)
                blur(at(along_x_, width_, x, y),
                     at(along_x_, width_, x, y + 1),
                     at(along_x_, width_, x, y + 2),
                     at(to, width_, x, y));
        }
    }

    static float* at(float* slice, std::size_t width, std::size_t x, std::size_t y) {
        return slice + (y * width + x) * floats_per_texel;
    }

    const Volume::State& state_;
    const RelitProbes& relit_;
    TexelBox box_;
    std::size_t width_;
    std::size_t height_;
    float* raw_;
    float* along_x_;
    std::array<float*, 3> flat_;
    std::array<std::int32_t, 3> held_ = {-1, -1, -1};
};

template <class Texel>
void write_blurred(const Volume::State& state, const RelitProbes& relit, const TexelBox& box) {
    SliceBlur slices(state, relit, box);
    const Encoder encoder = encoder_of(state);
    const Int3 size = state.texture_size();
    const auto width = static_cast<std::size_t>(box.high[0] - box.low[0]);
    for (std::int32_t z = box.low[2]; z < box.high[2]; ++z) {
        const std::int32_t tz = state.wrapped(2, z);
        const float* below = slices.flat(z - 1);
        const float* middle = slices.flat(z);
        const float* above = slices.flat(z + 1);
        for (std::int32_t y = box.low[1]; y < box.high[1]; ++y) {
            const std::int32_t ty = state.wrapped(1, y);
            for (std::int32_t x = box.low[0]; x < box.high[0]; ++x) {
                const std::size_t n = (static_cast<std::size_t>(y - box.low[1]) * width +
                                       static_cast<std::size_t>(x - box.low[0])) *
                                      floats_per_texel;
                std::array<float, floats_per_texel> sum;
                blur(below + n, middle + n, above + n, sum.data());
                for (std::size_t k = 0; k < texture_count; ++k) {
                    const float* channel = &sum[4 * k];
                    encoder.encode(Float4{channel[0], channel[1], channel[2], channel[3]},
                                   texture<Texel>(state, k)[offset_in(size, state.wrapped(0, x), ty, tz)]);
                }
            }
            for (std::size_t k = 0; k < texture_count; ++k)
                copy_to_borders(state, texture<Texel>(state, k), box.low[0], box.high[0], ty, tz);
        }
    }
}

std::int32_t floor_div16(std::int64_t column) {
    return static_cast<std::int32_t>(column >> 4);
}

}  // namespace

void look_under(Volume::State& state, const SectorSet& set, const RelitProbes& relit) {
    constexpr double cell_m = double{sector_size_m} / grid_size;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        for (std::size_t n = 0; n < state.places[axis].size(); ++n) {
            const double centre = state.centre_m(axis, static_cast<std::int32_t>(n));
            const auto column = static_cast<std::int64_t>(std::floor(centre / cell_m));
            state.places[axis][n] = {floor_div16(column), static_cast<std::int32_t>(column & 15)};
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
        const StoredGrid& grid = *under.sector->view.grid;
        for (std::size_t z = 0; z < size_z; ++z) {
            const double units = state.centre_m(2, static_cast<std::int32_t>(z)) * position_units_per_m -
                                 grid.z_origin_units;
            const double cell = std::floor(units / grid.cell_height_units);
            state.cells_z[n * size_z + z] = static_cast<std::uint8_t>(std::clamp(cell, 0.0, double{grid_size - 1}));
        }
    }
}

void encode_probes(Volume::State& state, const RelitProbes& relit) {
    if (state.settings.encoding == TexelEncoding::rgba16f)
        encode_sectors<std::uint64_t>(state, relit);
    else
        encode_sectors<std::uint32_t>(state, relit);
}

void write_box(Volume::State& state, const RelitProbes& relit, const TexelBox& box) {
    const bool wide = state.settings.encoding == TexelEncoding::rgba16f;
    if (state.settings.blur)
        wide ? write_blurred<std::uint64_t>(state, relit, box) : write_blurred<std::uint32_t>(state, relit, box);
    else
        wide ? write_plain<std::uint64_t>(state, box) : write_plain<std::uint32_t>(state, box);
}

Float4 stored_texel(const Volume::State& state, std::size_t k, const Int3& place) {
    const Int3 size = state.texture_size();
    const std::size_t at = offset_in(
        size, state.wrapped(0, place[0]), state.wrapped(1, place[1]), state.wrapped(2, place[2]));
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
