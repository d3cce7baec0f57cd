// The texels of a blurred volume (slide 60 of the talk): separable, slice by slice, on linear colours.
#include "volume_texels.h"

#include <algorithm>
#include <array>

namespace drtv {
namespace {

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
    return relit.colours(*under.sector, under.shown_probe(p));
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
void write_slices(const Volume::State& state, const RelitProbes& relit, const TexelBox& box) {
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

}  // namespace

void write_blurred(Volume::State& state, const RelitProbes& relit, const TexelBox& box) {
    if (state.settings.encoding == TexelEncoding::rgba16f)
        write_slices<std::uint64_t>(state, relit, box);
    else
        write_slices<std::uint32_t>(state, relit, box);
}

}  // namespace drtv
