// The C face. Structs that have the same layout on both sides are read where they lie.
#include <drtv/drtv.h>

#include <drtv/ambient.h>
#include <drtv/version.h>

#include "arena.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>

using namespace drtv;

struct drtv_set : SectorSet {
    using SectorSet::SectorSet;
};
struct drtv_relit : RelitProbes {
    using RelitProbes::RelitProbes;
};
struct drtv_volume : Volume {
    using Volume::Volume;
};

static_assert(sizeof(drtv_share) == sizeof(LightShare) + alignof(double) - sizeof(float) ||
              sizeof(drtv_share) == sizeof(LightShare));
static_assert(offsetof(drtv_share, source) == offsetof(LightShare, source) &&
              offsetof(drtv_share, light) == offsetof(LightShare, light) &&
              offsetof(drtv_share, intensity) == offsetof(LightShare, intensity));
static_assert(sizeof(drtv_box) == sizeof(TextureBox) && sizeof(drtv_sector_id) == sizeof(SectorId));

namespace {

constexpr std::size_t max_groups = 64;

Float3 float3(const float* v) {
    return {v[0], v[1], v[2]};
}
Double3 double3(const double* v) {
    return {v[0], v[1], v[2]};
}
void copy_sky(const DistantLight& from, float (*to)[4]) {
    std::memcpy(to, from.data(), sizeof from);
}

SectorSetLimits limits_of(const drtv_limits& limits) {
    return {limits.sectors, limits.probes, limits.interiors, limits.tiles};
}

VolumeSettings settings_of(const drtv_volume_settings& settings) {
    VolumeSettings result;
    std::copy_n(settings.size, 3, result.size.begin());
    std::copy_n(settings.texel_m, 3, result.texel_m.begin());
    result.encoding = static_cast<TexelEncoding>(std::clamp<std::int32_t>(settings.encoding, 0, 2));
    result.borders = settings.borders != 0;
    result.atlas = settings.atlas != 0;
    result.blur = settings.blur != 0;
    return result;
}

// A light with its groups, which it points to.
struct Light {
    explicit Light(const drtv_light& from) {
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
    Light(const Light&) = delete;
    Light& operator=(const Light&) = delete;

    std::array<GroupColour, max_groups> groups;
    SceneLight light;
};

std::span<const LightShare> shares_of(const drtv_share* shares, std::size_t count) {
    return {reinterpret_cast<const LightShare*>(shares), shares == nullptr ? 0 : count};
}

void tell(const ReadStatus& status, char* why, std::size_t why_bytes) {
    if (why == nullptr || why_bytes == 0)
        return;
    const std::size_t count = std::min(status.message.size(), why_bytes - 1);
    std::copy_n(status.message.data(), count, why);
    why[count] = 0;
}

std::span<const std::uint8_t> bytes_of(const void* file, std::size_t bytes) {
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

Shown shown_of(int shown) {
    return shown == DRTV_NEXT ? Shown::next : Shown::now;
}

}  // namespace

uint32_t drtv_abi(void) {
    return DRTV_ABI;
}
const char* drtv_version(void) {
    return DRTV_VERSION;
}

drtv_limits drtv_default_limits(void) {
    constexpr SectorSetLimits limits;
    return {limits.sectors, limits.probes, limits.interiors, limits.tiles};
}

size_t drtv_set_bytes(const drtv_limits* limits) {
    return Arena::bytes_of<drtv_set>(1) + SectorSet::memory_bytes(limits_of(*limits));
}

drtv_set* drtv_set_make(void* memory, size_t bytes, const drtv_limits* limits) {
    return make<drtv_set>(memory, bytes, drtv_set_bytes(limits), limits_of(*limits));
}

int drtv_set_load(drtv_set* set, const void* file, size_t file_bytes, char* why, size_t why_bytes) {
    ReadStatus status;
    const LoadStatus loaded = set->load(bytes_of(file, file_bytes), nullptr, &status);
    tell(status, why, why_bytes);
    return static_cast<int>(loaded);
}

int drtv_set_drop(drtv_set* set, int32_t i, int32_t j) {
    return set->drop({i, j}) ? 1 : 0;
}

void drtv_set_retire(drtv_set* set) {
    set->retire();
}

int drtv_set_has(const drtv_set* set, int32_t i, int32_t j) {
    return set->find({i, j}) != nullptr ? 1 : 0;
}

int drtv_set_use_tiles(drtv_set* set, const void* file, size_t file_bytes, char* why, size_t why_bytes) {
    std::span<const SkyTile> tiles;
    const ReadStatus status = open_tiles(bytes_of(file, file_bytes), tiles);
    tell(status, why, why_bytes);
    if (status.ok())
        set->use_tiles(tiles);
    return status.ok() ? 1 : 0;
}

size_t drtv_wanted_sectors(const double camera[3], double radius_m, drtv_sector_id* out, size_t room) {
    return wanted_sectors(double3(camera), radius_m, {reinterpret_cast<SectorId*>(out), room});
}

drtv_light drtv_default_light(void) {
    drtv_light light{};
    light.mode = DRTV_ACCURATE;
    light.sun_direction[2] = 1;
    std::fill_n(light.static_colour, 3, 1.0f);
    return light;
}

void drtv_constant_sky(const float radiance[3], float sky[3][4]) {
    copy_sky(constant_sky(float3(radiance)), sky);
}

void drtv_gradient_sky(const float zenith[3],
                       const float horizon[3],
                       const float sun_side[3],
                       const float to_sun[3],
                       float sky[3][4]) {
    copy_sky(gradient_sky({float3(zenith), float3(horizon), float3(sun_side)}, float3(to_sun)), sky);
}

void drtv_fit_sky(drtv_sky_radiance radiance, void* user, float sky[3][4]) {
    struct Caller {
        drtv_sky_radiance radiance;
        void* user;
    };
    Caller caller{radiance, user};
    const auto call = [](const Float3& w, void* to) {
        const Caller& asked = *static_cast<const Caller*>(to);
        Float3 found{};
        asked.radiance(w.data(), found.data(), asked.user);
        return found;
    };
    copy_sky(fit_sky(call, &caller), sky);
}

size_t drtv_split_light(const drtv_set* set, const drtv_lamp* lamp, drtv_share* shares) {
    const PointLight light{double3(lamp->position), float3(lamp->intensity)};
    std::array<LightShare, max_shares_per_light> split;
    const std::size_t count = split_light(*set, light, split);
    for (std::size_t n = 0; n < count; ++n) {
        shares[n] = {};
        std::memcpy(&shares[n], &split[n], offsetof(LightShare, intensity) + sizeof split[n].intensity);
    }
    return count;
}

size_t drtv_relit_bytes(const drtv_limits* limits, int with_fade) {
    return Arena::bytes_of<drtv_relit>(1) + RelitProbes::memory_bytes(limits_of(*limits), with_fade != 0);
}

drtv_relit* drtv_relit_make(void* memory, size_t bytes, const drtv_limits* limits, int with_fade) {
    return make<drtv_relit>(
        memory, bytes, drtv_relit_bytes(limits, with_fade), limits_of(*limits), with_fade != 0);
}

void drtv_relit_set_light(drtv_relit* relit, int shown, const drtv_light* light) {
    relit->set_light(shown_of(shown), Light(*light).light);
}

int drtv_relit_sector(drtv_relit* relit,
                      const drtv_set* set,
                      int shown,
                      drtv_sector_id sector,
                      const drtv_light* light,
                      const drtv_share* shares,
                      size_t share_count) {
    const LoadedSector* loaded = set->find({sector.i, sector.j});
    if (loaded == nullptr)
        return 0;
    relit->relight(shown_of(shown), *loaded, Light(*light).light, shares_of(shares, share_count));
    return 1;
}

void drtv_relit_set_fade(drtv_relit* relit, float share) {
    relit->set_fade(share);
}

void drtv_relit_finish_fade(drtv_relit* relit) {
    relit->finish_fade();
}

float drtv_relit_largest(const drtv_relit* relit, const drtv_set* set) {
    float largest = relit->largest_fallback();
    for (std::uint32_t slot = 0; slot < set->limits().sectors; ++slot) {
        const LoadedSector* sector = set->at(slot);
        if (sector != nullptr && relit->is_relit(*sector))
            largest = std::max(largest, relit->largest(*sector));
    }
    return largest;
}

drtv_volume_settings drtv_default_volume(void) {
    const VolumeSettings settings;
    drtv_volume_settings result{};
    std::copy_n(settings.size.begin(), 3, result.size);
    std::copy_n(settings.texel_m.begin(), 3, result.texel_m);
    result.borders = 1;
    return result;
}

size_t drtv_volume_bytes(const drtv_volume_settings* settings, const drtv_limits* limits) {
    const VolumeSettings asked = settings_of(*settings);
    if (!Volume::is_possible(asked))
        return 0;
    return Arena::bytes_of<drtv_volume>(1) + Volume::memory_bytes(asked, limits_of(*limits));
}

drtv_volume* drtv_volume_make(void* memory,
                              size_t bytes,
                              const drtv_volume_settings* settings,
                              const drtv_limits* limits) {
    return make<drtv_volume>(
        memory, bytes, drtv_volume_bytes(settings, limits), settings_of(*settings), limits_of(*limits));
}

float drtv_suggest_scale(float largest, float current) {
    return suggest_scale(largest, current);
}

void drtv_volume_set_scale(drtv_volume* volume, float scale) {
    if (scale > 0)
        volume->set_scale(scale);
}

void drtv_volume_update(drtv_volume* volume,
                        const drtv_set* set,
                        const drtv_relit* relit,
                        const double camera[3],
                        int write_all) {
    if (write_all != 0)
        volume->update_all(*set, *relit, double3(camera));
    else
        volume->update(*set, *relit, double3(camera));
}

const drtv_box* drtv_volume_dirty(const drtv_volume* volume, size_t* count) {
    const std::span<const TextureBox> boxes = volume->dirty();
    *count = boxes.size();
    return reinterpret_cast<const drtv_box*>(boxes.data());
}

void drtv_volume_texture_size(const drtv_volume* volume, int32_t size[3]) {
    const auto texture = volume->texture_size();
    std::copy_n(texture.begin(), 3, size);
}

const void* drtv_volume_texels(const drtv_volume* volume, uint32_t k, size_t* bytes) {
    if (k >= channel_count)
        return nullptr;
    const std::span<const std::byte> texels = volume->texels(k);
    *bytes = texels.size();
    return texels.data();
}

void drtv_volume_shader_inputs(const drtv_volume* volume, drtv_shader_inputs* inputs) {
    const VolumeShaderInputs from = volume->shader_inputs();
    *inputs = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        inputs->snapped_camera[axis] = from.snapped_camera[axis];
        inputs->uv_scale[axis] = from.uv_scale[axis];
        inputs->wrap_offset[axis] = from.wrap_offset[axis];
        inputs->uvw_multiply[axis] = from.uvw_multiply[axis];
        inputs->uvw_add[axis] = from.uvw_add[axis];
    }
    inputs->scale = from.scale;
}

drtv_ambient_place drtv_default_place(void) {
    drtv_ambient_place place{};
    place.normal[2] = 1;
    place.sampling = DRTV_TRILINEAR;
    place.interiors = 1;
    place.interior_soft_m = 1;
    return place;
}

void drtv_ambient_at(const drtv_set* set,
                     const drtv_light* light,
                     const drtv_share* shares,
                     size_t share_count,
                     const drtv_ambient_place* place,
                     drtv_ambient* ambient) {
    AmbientPlace asked;
    asked.at = double3(place->at);
    asked.normal = float3(place->normal);
    asked.sampling = place->sampling == DRTV_NEAREST ? Sampling::nearest : Sampling::trilinear;
    asked.offset_m = place->offset_m;
    asked.interiors = place->interiors != 0;
    asked.interior_soft_m = place->interior_soft_m;
    const Ambient found = ambient_at(*set, Light(*light).light, shares_of(shares, share_count), asked);
    *ambient = {};
    ambient->status = static_cast<std::int32_t>(found.status);
    ambient->interior = found.interior.share;
    std::memcpy(ambient->basis_colours, found.colours.data(), sizeof found.colours);
    std::copy_n(found.colour.begin(), 3, ambient->colour);
}

void drtv_shade_ambient(int mode, const float basis_colours[4][3], const float normal[3], float colour[3]) {
    BasisColours colours;
    std::memcpy(colours.data(), basis_colours, sizeof colours);
    const RelightMode how = mode == DRTV_LITERAL ? RelightMode::literal : RelightMode::accurate;
    const Float3 shaded = shade_ambient(how, clamped(colours), float3(normal));
    std::copy_n(shaded.begin(), 3, colour);
}
