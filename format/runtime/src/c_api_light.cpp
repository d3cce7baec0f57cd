// The C face: sectors, light, places.
#include "c_api.h"

#include <drtv/day.h>
#include <drtv/version.h>

using namespace drtv;

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
    if (loaded != LoadStatus::loaded && status.ok())
        status.message = sentence_of(loaded);
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

drtv_light drtv_light_of_default_day(double hour) {
    const SceneLight from = light_of_day(default_day(), hour, RelightMode::accurate, {});
    drtv_light light = drtv_default_light();
    copy_sky(from.sky, light.sky);
    std::copy_n(from.sun.irradiance.begin(), 3, light.sun_irradiance);
    std::copy_n(from.sun.direction.begin(), 3, light.sun_direction);
    std::copy_n(from.other_groups.begin(), 3, light.other_groups);
    return light;
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

drtv_ambient_place drtv_default_place(void) {
    drtv_ambient_place place{};
    place.normal[2] = 1;
    place.sampling = DRTV_TRILINEAR;
    place.interiors = 1;
    place.interior_soft_m = 1;
    return place;
}

namespace {

AmbientPlace place_of(const drtv_ambient_place& place) {
    AmbientPlace asked;
    asked.at = double3(place.at);
    asked.normal = float3(place.normal);
    asked.sampling = place.sampling == DRTV_NEAREST ? Sampling::nearest : Sampling::trilinear;
    asked.offset_m = place.offset_m;
    asked.interiors = place.interiors != 0;
    asked.interior_soft_m = place.interior_soft_m;
    return asked;
}

drtv_ambient ambient_of(const Ambient& found) {
    drtv_ambient ambient{};
    ambient.status = static_cast<std::int32_t>(found.status);
    ambient.interior = found.interior.share;
    copy_colours(found.colours, ambient.basis_colours);
    std::copy_n(found.colour.begin(), 3, ambient.colour);
    return ambient;
}

}  // namespace

void drtv_ambient_at(const drtv_set* set,
                     const drtv_light* light,
                     const drtv_share* shares,
                     size_t share_count,
                     const drtv_ambient_place* place,
                     drtv_ambient* ambient) {
    const GameLight of(*light);
    *ambient = ambient_of(ambient_at(*set, of.light, shares_of(shares, share_count), place_of(*place)));
}

void drtv_ambient_in(const drtv_volume* volume,
                     const drtv_set* set,
                     const drtv_light* light,
                     const drtv_share* shares,
                     size_t share_count,
                     const drtv_ambient_place* place,
                     drtv_ambient* ambient) {
    const GameLight of(*light);
    *ambient =
        ambient_of(ambient_in(*volume, *set, of.light, shares_of(shares, share_count), place_of(*place)));
}

int drtv_interior_at(const drtv_set* set, const double place[3], float soft_m, drtv_interior* interior) {
    const InteriorShare found = set->interior(double3(place), soft_m);
    *interior = {};
    if (found.sector == nullptr)
        return 0;
    const SectorView& view = found.sector->view;
    *interior = {{view.i, view.j}, view.interiors[found.index].probe, found.share};
    return 1;
}

float drtv_sky_factor(const drtv_set* set, const double place[3]) {
    return set->sky_factor(double3(place));
}

void drtv_shade_ambient(int mode, const float basis_colours[4][3], const float normal[3], float colour[3]) {
    BasisColours colours;
    std::memcpy(colours.data(), basis_colours, sizeof colours);
    const RelightMode how = mode == DRTV_LITERAL ? RelightMode::literal : RelightMode::accurate;
    const Float3 shaded = shade_ambient(how, clamped(colours), float3(normal));
    std::copy_n(shaded.begin(), 3, colour);
}
