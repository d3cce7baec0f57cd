// From relit probes to the texels of a volume.
#include "half.h"
#include "volume_state.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

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
    const auto row =
        static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y);
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
            texels[sector.first_probe + p] = encoder.encode<Texel>(texel_colours(relit.colours(sector, p)));
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

// Runs of a box. REQUIRES: room for all: two more than sectors under the window, along x.
std::size_t runs_of(const Volume::State& state,
                    std::int32_t x0,
                    std::int32_t x1,
                    std::span<Volume::State::Run> runs) {
    const auto& places = state.places[0];
    const auto place = [&](std::int32_t x) { return places[static_cast<std::size_t>(x)]; };
    const std::int32_t first_border = state.border();
    std::size_t count = 0;
    for (std::int32_t x = x0; x < x1;) {
        Volume::State::Run run{x, place(x).to, 1, 0, true};
        run.under = static_cast<std::size_t>(place(x).sector - state.under_first.i);
        const std::int32_t until_wrap = state.settings.size[0] + first_border - run.to;
        while (x + run.length < x1 && run.length < until_wrap &&
               place(x + run.length).sector == place(x).sector) {
            run.whole_cells = run.whole_cells && place(x + run.length).cell == place(x).cell + run.length;
            ++run.length;
        }
        x += run.length;
        runs[count++] = run;
    }
    return count;
}

// Writes rows of the window to three rows of texels, where x is wrapped.
template <class Texel>
class RowWriter {
  public:
    RowWriter(const Volume::State& state, std::int32_t x0, std::int32_t x1)
        : state_(state),
          encoder_(encoder_of(state)),
          probes_(encoded_probes<Texel>(state)),
          open_(encoder_.encode<Texel>(texel_colours(state.fallback))),
          run_count_(runs_of(state, x0, x1, state.runs)) {}

    void write(const std::array<Texel*, texture_count>& rows, std::int32_t y, std::int32_t z) const {
        const Volume::State::Place& place_y = state_.place(1, y);
        const auto across = static_cast<std::size_t>(state_.under_size[0]);
        const auto row = static_cast<std::size_t>(place_y.sector - state_.under_first.j);
        const Volume::State::Under* row_under = state_.under.data() + row * across;
        const auto cell_y = static_cast<std::size_t>(place_y.cell);
        for (const Volume::State::Run& run : std::span(state_.runs).first(run_count_)) {
            const Volume::State::Under& under = row_under[run.under];
            const std::array<Texel*, texture_count> to = {
                rows[0] + run.to, rows[1] + run.to, rows[2] + run.to};
            if (under.sector == nullptr) {
                write_fallback(to, run, under, y, z);
                continue;
            }
            const std::size_t cell_z = under.cells_z[z];
            const std::uint8_t* cells =
                under.sector->view.grid->cells.data() + grid_size * (cell_y + grid_size * cell_z);
            write_probes(to, run, under, cells, y, z);
        }
    }

  private:
    void write_probes(const std::array<Texel*, texture_count>& to,
                      const Volume::State::Run& run,
                      const Volume::State::Under& under,
                      const std::uint8_t* cells,
                      std::int32_t y,
                      std::int32_t z) const {
        const ProbeTexels<Texel>* probes = probes_.data() + under.sector->first_probe;
        const std::size_t count = under.sector->view.probe_count;
        const Volume::State::Place* places = &state_.places[0][static_cast<std::size_t>(run.x)];
        Texel* const first = to[0];
        Texel* const second = to[1];
        Texel* const third = to[2];
        const auto put = [&](std::int32_t n, std::uint8_t p) {
            if (p < count) [[likely]] {
                const Texel* texels = probes[p].data();
                first[n] = texels[0];
                second[n] = texels[1];
                third[n] = texels[2];
                return;
            }
            const ProbeTexels<Texel> texels = fallback_texels(under, {run.x + n, y, z});
            first[n] = texels[0];
            second[n] = texels[1];
            third[n] = texels[2];
        };
        if (run.whole_cells) {
            const std::uint8_t* cell = cells + places[0].cell;
            for (std::int32_t n = 0; n < run.length; ++n)
                put(n, cell[n]);
        } else {
            for (std::int32_t n = 0; n < run.length; ++n)
                put(n, cells[places[n].cell]);
        }
    }

    void write_fallback(const std::array<Texel*, texture_count>& to,
                        const Volume::State::Run& run,
                        const Volume::State::Under& under,
                        std::int32_t y,
                        std::int32_t z) const {
        for (std::int32_t n = 0; n < run.length; ++n) {
            const ProbeTexels<Texel> texels = fallback_texels(under, {run.x + n, y, z});
            for (std::size_t k = 0; k < texture_count; ++k)
                to[k][n] = texels[k];
        }
    }

    [[nodiscard]] ProbeTexels<Texel> fallback_texels(const Volume::State::Under& under,
                                                     const Int3& place) const {
        if (under.tile == nullptr)
            return open_;
        return encoder_.encode<Texel>(texel_colours(fallback_at(state_, under, place)));
    }

    const Volume::State& state_;
    Encoder encoder_;
    std::span<const ProbeTexels<Texel>> probes_;
    ProbeTexels<Texel> open_;
    std::size_t run_count_;
};

// Copies what the box has in a row of a texture to the borders along all axes.
template <class Texel>
class BorderCopier {
  public:
    BorderCopier(const Volume::State& state, const TexelBox& box)
        : state_(state), size_(state.texture_size()), length_(state.settings.size[0]) {
        const std::int32_t count = box.high[0] - box.low[0];
        first_ = state.place(0, box.low[0]).to;
        head_ = std::min(count, length_ + state.border() - first_);
        rest_ = count - head_;
        has_last_ = state.border() == 1 && first_ + head_ == length_ + 1;
        has_first_ = state.border() == 1 && (first_ == 1 || rest_ > 0);
    }

    [[nodiscard]] bool has_copies(std::int32_t y, std::int32_t z) const {
        return has_first_ || has_last_ || state_.place(1, y).copy >= 0 || state_.place(2, z).copy >= 0;
    }

    // The row of the window at y and z, in a texture.
    void copy(Texel* base, std::int32_t y, std::int32_t z) const {
        const Volume::State::Place& place_y = state_.place(1, y);
        const Volume::State::Place& place_z = state_.place(2, z);
        Texel* row = base + offset_in(size_, 0, place_y.to, place_z.to);
        if (has_last_)
            row[0] = row[length_];
        if (has_first_)
            row[length_ + 1] = row[1];
        if (place_y.copy >= 0)
            copy_row(row, base + offset_in(size_, 0, place_y.copy, place_z.to));
        if (place_z.copy >= 0)
            copy_row(row, base + offset_in(size_, 0, place_y.to, place_z.copy));
        if (place_y.copy >= 0 && place_z.copy >= 0)
            copy_row(row, base + offset_in(size_, 0, place_y.copy, place_z.copy));
    }

  private:
    void copy_row(const Texel* row, Texel* to) const {
        std::copy_n(row + first_, head_, to + first_);
        std::copy_n(row + state_.border(), rest_, to + state_.border());
        if (has_last_)
            to[0] = row[0];
        if (has_first_)
            to[length_ + 1] = row[length_ + 1];
    }

    const Volume::State& state_;
    Int3 size_;
    std::int32_t length_;
    std::int32_t first_;  // of the texture
    std::int32_t head_;   // texels until the wrap
    std::int32_t rest_;   // and behind it
    bool has_last_;
    bool has_first_;
};

template <class Texel>
void write_plain(const Volume::State& state, const TexelBox& box) {
    const RowWriter<Texel> writer(state, box.low[0], box.high[0]);
    const BorderCopier<Texel> borders(state, box);
    const Int3 size = state.texture_size();
    const std::array<Texel*, texture_count> bases = {
        texture<Texel>(state, 0), texture<Texel>(state, 1), texture<Texel>(state, 2)};
    for (std::int32_t z = box.low[2]; z < box.high[2]; ++z) {
        for (std::int32_t y = box.low[1]; y < box.high[1]; ++y) {
            const std::size_t row = offset_in(size, 0, state.place(1, y).to, state.place(2, z).to);
            writer.write({bases[0] + row, bases[1] + row, bases[2] + row}, y, z);
            if (!borders.has_copies(y, z))
                continue;
            for (Texel* base : bases)
                borders.copy(base, y, z);
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
    const std::size_t cell_x =
        static_cast<std::size_t>(state.places[0][static_cast<std::size_t>(place[0])].cell);
    const std::size_t cell_y =
        static_cast<std::size_t>(state.places[1][static_cast<std::size_t>(place[1])].cell);
    const std::size_t cell_z = under.cells_z[place[2]];
    const std::uint8_t p = under.sector->view.grid->cells[cell_x + grid_size * (cell_y + grid_size * cell_z)];
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
                const std::int32_t at_x =
                    std::clamp(box_.low[0] + static_cast<std::int32_t>(x) - 1, 0, size[0] - 1);
                const std::int32_t at_y =
                    std::clamp(box_.low[1] + static_cast<std::int32_t>(y) - 1, 0, size[1] - 1);
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
    const BorderCopier<Texel> borders(state, box);
    const Encoder encoder = encoder_of(state);
    const Int3 size = state.texture_size();
    const auto width = static_cast<std::size_t>(box.high[0] - box.low[0]);
    for (std::int32_t z = box.low[2]; z < box.high[2]; ++z) {
        const std::int32_t tz = state.place(2, z).to;
        const float* below = slices.flat(z - 1);
        const float* middle = slices.flat(z);
        const float* above = slices.flat(z + 1);
        for (std::int32_t y = box.low[1]; y < box.high[1]; ++y) {
            const std::int32_t ty = state.place(1, y).to;
            for (std::int32_t x = box.low[0]; x < box.high[0]; ++x) {
                const std::size_t n = (static_cast<std::size_t>(y - box.low[1]) * width +
                                       static_cast<std::size_t>(x - box.low[0])) *
                                      floats_per_texel;
                std::array<float, floats_per_texel> sum;
                blur(below + n, middle + n, above + n, sum.data());
                for (std::size_t k = 0; k < texture_count; ++k) {
                    const float* channel = &sum[4 * k];
                    encoder.encode(Float4{channel[0], channel[1], channel[2], channel[3]},
                                   texture<Texel>(state, k)[offset_in(size, state.place(0, x).to, ty, tz)]);
                }
            }
            for (std::size_t k = 0; k < texture_count; ++k)
                borders.copy(texture<Texel>(state, k), y, z);
        }
    }
}

std::int32_t floor_div16(std::int64_t column) {
    return static_cast<std::int32_t>(column >> 4);
}

}  // namespace

void look_under(Volume::State& state, const SectorSet& set, const RelitProbes& relit) {
    constexpr double cell_m = double{sector_size_m} / grid_size;
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

void write_box(Volume::State& state, const RelitProbes& relit, const TexelBox& box) {
    const bool wide = state.settings.encoding == TexelEncoding::rgba16f;
    if (state.settings.blur)
        wide ? write_blurred<std::uint64_t>(state, relit, box)
             : write_blurred<std::uint32_t>(state, relit, box);
    else
        wide ? write_plain<std::uint64_t>(state, box) : write_plain<std::uint32_t>(state, box);
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
