// Texels of a volume: how colours are encoded, and where they stand.
#pragma once

#include "half.h"
#include "volume_state.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace drtv {

// A texel of each texture: [k][r, g, b, a].
using TexelColours = std::array<Float4, channel_count>;

inline constexpr std::size_t texture_count = channel_count;
inline constexpr float code_max = 255;

template <class Texel>
using ProbeTexels = std::array<Texel, texture_count>;

// Not below 0, in codes.
[[nodiscard]] inline std::uint32_t code_of(float codes) {
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

[[nodiscard]] inline Encoder encoder_of(const Volume::State& state) {
    return {state.settings.encoding, 1 / state.scale};
}

[[nodiscard]] inline TexelColours texel_colours(const BasisColours& colours) {
    TexelColours texels;
    for (std::size_t k = 0; k < texture_count; ++k)
        texels[k] = {colours[k][0], colours[k][1], colours[k][2], colours[3][k]};
    return texels;
}

template <class Texel>
[[nodiscard]] std::span<ProbeTexels<Texel>> encoded_probes(const Volume::State& state) {
    auto* first = reinterpret_cast<ProbeTexels<Texel>*>(state.encoded.data());
    return {first, state.encoded.size() / sizeof(ProbeTexels<Texel>)};
}

template <class Texel>
[[nodiscard]] Texel* texture(const Volume::State& state, std::size_t k) {
    return reinterpret_cast<Texel*>(state.texels.data()) + k * state.texels_per_texture();
}

[[nodiscard]] inline std::size_t offset_in(const Int3& size, std::int32_t x, std::int32_t y, std::int32_t z) {
    const auto row =
        static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y);
    return row * static_cast<std::size_t>(size[0]) + static_cast<std::size_t>(x);
}

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

}  // namespace drtv
