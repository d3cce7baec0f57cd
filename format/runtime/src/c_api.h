// What the files of the C face share. Structs that have the same layout on both sides are read where they
// lie.
#pragma once

#include <drtv/ambient.h>
#include <drtv/drtv.h>

#include "arena.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>

struct drtv_set : drtv::SectorSet {
    using SectorSet::SectorSet;
};
struct drtv_relit : drtv::RelitProbes {
    using RelitProbes::RelitProbes;
};
struct drtv_volume : drtv::Volume {
    using Volume::Volume;
};

namespace drtv {

static_assert(sizeof(drtv_share) == sizeof(LightShare) + alignof(double) - sizeof(float) ||
              sizeof(drtv_share) == sizeof(LightShare));
static_assert(offsetof(drtv_share, source) == offsetof(LightShare, source) &&
              offsetof(drtv_share, light) == offsetof(LightShare, light) &&
              offsetof(drtv_share, intensity) == offsetof(LightShare, intensity));
static_assert(sizeof(drtv_box) == sizeof(TextureBox) && sizeof(drtv_sector_id) == sizeof(SectorId));

inline constexpr std::size_t max_groups = 64;

inline Float3 float3(const float* v) {
    return {v[0], v[1], v[2]};
}
inline Double3 double3(const double* v) {
    return {v[0], v[1], v[2]};
}
inline void copy_sky(const DistantLight& from, float (*to)[4]) {
    std::memcpy(to, from.data(), sizeof from);
}

inline void copy_colours(const BasisColours& from, float (*to)[3]) {
    std::memcpy(to, from.data(), sizeof from);
}

inline SectorSetLimits limits_of(const drtv_limits& limits) {
    return {limits.sectors, limits.probes, limits.interiors, limits.tiles};
}

inline VolumeSettings settings_of(const drtv_volume_settings& settings) {
    VolumeSettings result;
    std::copy_n(settings.size, 3, result.size.begin());
    std::copy_n(settings.texel_m, 3, result.texel_m.begin());
    result.encoding = static_cast<TexelEncoding>(std::clamp<std::int32_t>(settings.encoding, 0, 2));
    result.borders = settings.borders != 0;
    result.atlas = settings.atlas != 0;
    result.blur = settings.blur != 0;
    result.outdoors = settings.outdoors != 0;
    return result;
}

// A light with its groups, which it points to.
struct GameLight {
    explicit GameLight(const drtv_light& from) {
        light.mode = from.mode == DRTV_LITERAL ? RelightMode::literal : RelightMode::accurate;
        std::memcpy(light.sky.data(), from.sky, sizeof light.sky);
        light.sun = {float3(from.sun_irradiance), float3(from.sun_direction)};
        light.static_colour = float3(from.static_colour);
        light.other_groups = float3(from.other_groups);
        const std::size_t count = from.groups == nullptr ? 0 : std::min(from.group_count, max_groups);
        for (std::size_t n = 0; n < count; ++n)
            groups[n] = {from.groups[n].name, float3(from.groups[n].colour)};
        light.groups = {groups.data(), count};
    }
    GameLight(const GameLight&) = delete;
    GameLight& operator=(const GameLight&) = delete;

    std::array<GroupColour, max_groups> groups;
    SceneLight light;
};

inline std::span<const LightShare> shares_of(const drtv_share* shares, std::size_t count) {
    return {reinterpret_cast<const LightShare*>(shares), shares == nullptr ? 0 : count};
}

inline void tell(const ReadStatus& status, char* why, std::size_t why_bytes) {
    if (why == nullptr || why_bytes == 0)
        return;
    const std::size_t count = std::min(status.message.size(), why_bytes - 1);
    std::copy_n(status.message.data(), count, why);
    why[count] = 0;
}

inline std::span<const std::uint8_t> bytes_of(const void* file, std::size_t bytes) {
    return {static_cast<const std::uint8_t*>(file), file == nullptr ? 0 : bytes};
}

// Makes an object at the start of the memory, which gets the rest. Null where it is too small or lies
// wrongly.
template <class Object, class... Arguments>
Object* make(void* memory, std::size_t bytes, std::size_t needed, const Arguments&... arguments) {
    const bool aligned = reinterpret_cast<std::uintptr_t>(memory) % Arena::alignment == 0;
    if (memory == nullptr || !aligned || needed == 0 || bytes < needed)
        return nullptr;
    const std::size_t head = Arena::bytes_of<Object>(1);
    const std::span<std::byte> rest(static_cast<std::byte*>(memory) + head, needed - head);
    return std::construct_at(static_cast<Object*>(memory), rest, arguments...);
}

inline Shown shown_of(int shown) {
    return shown == DRTV_NEXT ? Shown::next : Shown::now;
}

}  // namespace drtv
