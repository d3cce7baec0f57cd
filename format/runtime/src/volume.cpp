#include <drtv/volume.h>

#include "arena.h"
#include "columns.h"
#include "volume_state.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace drtv {

float suggest_scale(float largest, float current) {
    constexpr float lowest = 0x1p-60f;
    constexpr float highest = 0x1p60f;
    const bool fits = current > 0 && largest <= current / 2 && largest > current / 8;
    if (fits)
        return current;
    if (!(largest > 0))
        return current > 0 ? current : 1;
    float scale = lowest;
    while (scale < highest && scale < 2 * largest)
        scale *= 2;
    return scale;
}

bool Volume::is_possible(const VolumeSettings& settings) {
    constexpr std::int32_t max_size = 1024;
    constexpr float min_texel_m = 0.25f;
    constexpr float max_texel_m = 64;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool size_fits = settings.size[axis] >= 2 && settings.size[axis] <= max_size;
        const bool width_fits =
            settings.texel_m[axis] >= min_texel_m && settings.texel_m[axis] <= max_texel_m;
        if (!size_fits || !width_fits)
            return false;
    }
    return settings.borders || !settings.atlas;
}

std::size_t Volume::memory_bytes(const VolumeSettings& settings, const SectorSetLimits& limits) {
    return Arena::bytes_of<State>(1) + State::memory_bytes(settings, limits);
}

Volume::Volume(std::span<std::byte> memory, const VolumeSettings& settings, const SectorSetLimits& limits)
    : state_(std::construct_at(reinterpret_cast<State*>(memory.data()),
                               settings,
                               limits,
                               memory.subspan(Arena::bytes_of<State>(1)))) {}

void Volume::set_scale(float scale) {
    if (scale == state_->scale || state_->settings.encoding == TexelEncoding::rgba16f)
        return;
    state_->scale = scale;
    state_->stale = true;
    std::fill(state_->encoded_of.begin(), state_->encoded_of.end(), State::Encoded{});
}

float Volume::scale() const {
    return state_->scale;
}

void Volume::update(const SectorSet& set, const RelitProbes& relit, const Double3& camera_m) {
    update_volume(*state_, set, relit, camera_m, false);
}

void Volume::update_all(const SectorSet& set, const RelitProbes& relit, const Double3& camera_m) {
    update_volume(*state_, set, relit, camera_m, true);
}

std::span<const TextureBox> Volume::dirty() const {
    return {state_->dirty.data(), state_->dirty_count};
}

std::array<std::int32_t, 3> Volume::texture_size() const {
    const Int3 one = state_->texture_size();
    return {one[0], one[1], state_->settings.atlas ? 3 * one[2] : one[2]};
}

std::size_t Volume::texel_bytes() const {
    return state_->settings.encoding == TexelEncoding::rgba16f ? 8 : 4;
}

std::span<const std::byte> Volume::texels(std::size_t k) const {
    const std::size_t bytes = state_->texels_per_texture() * texel_bytes();
    return state_->texels.subspan(k * bytes, bytes);
}

VolumeShaderInputs Volume::shader_inputs() const {
    const VolumeSettings& settings = state_->settings;
    VolumeShaderInputs inputs;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t size = settings.size[axis];
        const auto length = static_cast<float>(size);
        const double middle = static_cast<double>(state_->window[axis]) + 0.5 * size;
        inputs.snapped_camera[axis] = middle * static_cast<double>(settings.texel_m[axis]);
        inputs.uv_scale[axis] = 1 / (length * settings.texel_m[axis]);
        // frac(middle / N - 1/2), of whole numbers.
        inputs.wrap_offset[axis] = static_cast<float>(modulo(state_->window[axis], size)) / length;
        const float with_borders = length + 2;
        inputs.uvw_multiply[axis] = settings.borders ? length / with_borders : 1;
        inputs.uvw_add[axis] = settings.borders ? 1 / with_borders : 0;
    }
    inputs.scale = state_->scale;
    return inputs;
}

std::array<std::int32_t, 3> Volume::window() const {
    return state_->window;
}

bool Volume::is_filled() const {
    return state_->filled;
}

const VolumeSettings& Volume::settings() const {
    return state_->settings;
}

Volume::Sample Volume::sample(const Double3& world_m) const {
    Sample sample;
    const VolumeSettings& settings = state_->settings;
    std::array<std::int32_t, 3> low{};
    std::array<float, 3> above{};
    float weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double width = static_cast<double>(settings.texel_m[axis]);
        const double texels = world_m[axis] / width - static_cast<double>(state_->window[axis]);
        const double length = static_cast<double>(settings.size[axis]);
        const double to_side = std::min(texels, length - texels);
        if (!(to_side > 0.5))
            return {};
        weight = std::min(weight, static_cast<float>(to_side - 0.5));
        const double from_centre = texels - 0.5;
        const double floor = std::min(std::floor(from_centre), length - 2);
        low[axis] = static_cast<std::int32_t>(floor);
        above[axis] = static_cast<float>(from_centre - floor);
    }
    sample.weight = weight;
    for (std::size_t k = 0; k < channel_count; ++k) {
        Float4 sum{};
        for (int n = 0; n < 8; ++n) {
            Int3 place = low;
            float share = 1;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const bool next = (n >> axis & 1) != 0;
                place[axis] += next ? 1 : 0;
                share *= next ? above[axis] : 1 - above[axis];
            }
            const Float4 texel = stored_texel(*state_, k, place);
            for (std::size_t c = 0; c < 4; ++c)
                sum[c] += share * texel[c];
        }
        if (settings.encoding == TexelEncoding::rgba8_sqrt) {
            for (float& channel : sum)
                channel = channel * channel * state_->scale;
        }
        sample.colours[k] = {sum[0], sum[1], sum[2]};
        sample.colours[3][k] = sum[3];
    }
    return sample;
}

}  // namespace drtv
