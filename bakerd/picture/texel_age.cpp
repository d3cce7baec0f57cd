#include "bakerd/picture/texel_age.h"

#include <array>
#include <cmath>

namespace drtv::picture {

TexelAge::TexelAge(const SectorSet& set,
                   const kit::RequestedLight& light,
                   const RelightChoice& choice,
                   const glm::vec3& eye,
                   const glm::vec3& forward)
    : settings_(volume_settings(choice)) {
    settings_.borders = false;
    written_.resize(static_cast<std::size_t>(settings_.size[0]) *
                    static_cast<std::size_t>(settings_.size[1]) *
                    static_cast<std::size_t>(settings_.size[2]));
    kit::RelitVolume relit(set, light.light, {}, settings_);
    for (int frame = 0; frame <= frames; ++frame)
        note(relit.at(as_place(eye - forward * (step_m * static_cast<float>(frames - frame)))), frame);
}

void TexelAge::note(const Volume& volume, int frame) {
    const auto& size = settings_.size;
    window_ = volume.window();
    for (const TextureBox& box : volume.dirty()) {
        for (std::int32_t z = box.offset[2]; z < box.offset[2] + box.size[2]; ++z) {
            for (std::int32_t y = box.offset[1]; y < box.offset[1] + box.size[1]; ++y) {
                for (std::int32_t x = box.offset[0]; x < box.offset[0] + box.size[0]; ++x)
                    written_[static_cast<std::size_t>((z * size[1] + y) * size[0] + x)] = frame;
            }
        }
    }
}

int TexelAge::frames_at(const glm::vec3& place) const {
    std::array<std::int32_t, 3> texel{};
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::size_t>(axis);
        const auto of_world = static_cast<std::int32_t>(std::floor(place[axis] / settings_.texel_m[n]));
        const std::int32_t count = settings_.size[n];
        if (of_world < window_[n] || of_world >= window_[n] + count)
            return frames;
        texel[n] = (of_world % count + count) % count;
    }
    const auto index =
        static_cast<std::size_t>((texel[2] * settings_.size[1] + texel[1]) * settings_.size[0] + texel[0]);
    return frames - written_[index];
}

}  // namespace drtv::picture
