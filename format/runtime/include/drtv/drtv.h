/* The runtime for C11 and anything that calls C: Unity (P/Invoke), Rust, Python, Lua. libdrtv is a shared
 * library that exports only these names, over the C++ of drtv/sector_set.h, relit_probes.h, volume.h,
 * ambient.h and light.h. Those headers say, under the same names, what a call does, which units it takes and
 * which calls may run at once. In CMake it is drtv::c. Long because C callers include one header.
 *
 * Memory is the caller's: ask for the size, pass a block that starts at a multiple of 16, and free it when
 * the handle is no longer used. There is nothing else to free. After that only the text of an error is
 * allocated.
 *
 *     drtv_limits limits = drtv_default_limits();
 *     size_t bytes = drtv_set_bytes(&limits);
 *     drtv_set* set = drtv_set_make(aligned_alloc(16, bytes), bytes, &limits);
 *     drtv_set_load(set, file, file_bytes, NULL, 0);
 */
#ifndef DRTV_DRTV_H
#define DRTV_DRTV_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(DRTV_BUILDS_C)
#define DRTV_API __declspec(dllexport)
#elif defined(_WIN32)
#define DRTV_API __declspec(dllimport)
#elif defined(__GNUC__)
#define DRTV_API __attribute__((visibility("default")))
#else
#define DRTV_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Rises with a release that breaks compiled callers. Compare it with drtv_abi(). */
#define DRTV_ABI 1
DRTV_API uint32_t drtv_abi(void);
/* "0.1.0" */
DRTV_API const char* drtv_version(void);

/* ---- Sectors */

typedef struct drtv_set drtv_set;

typedef struct drtv_limits {
    uint32_t sectors;
    uint32_t probes;
    uint32_t interiors;
    uint32_t tiles;
} drtv_limits;
DRTV_API drtv_limits drtv_default_limits(void);

DRTV_API size_t drtv_set_bytes(const drtv_limits* limits);
/* NULL where the memory is too small or does not start at a multiple of 16. All makers do the same. */
DRTV_API drtv_set* drtv_set_make(void* memory, size_t bytes, const drtv_limits* limits);

enum { DRTV_LOADED = 0, DRTV_UNREADABLE = 1, DRTV_ALREADY_THERE = 2, DRTV_NO_ROOM = 3 };
/* The file's bytes must start at a multiple of 16 and stay in place until `retire` after `drop`; until then
 * the sector counts as already there. `why`, where it is not NULL, gets the text of an error, cut to
 * `why_bytes` with a 0 at its end. */
DRTV_API int drtv_set_load(drtv_set* set, const void* file, size_t file_bytes, char* why, size_t why_bytes);
/* 1 where the sector was there, else 0. */
DRTV_API int drtv_set_drop(drtv_set* set, int32_t i, int32_t j);
DRTV_API void drtv_set_retire(drtv_set* set);
DRTV_API int drtv_set_has(const drtv_set* set, int32_t i, int32_t j);
/* A file of tiles; its bytes must stay in place. 1 where it could be read, else 0. */
DRTV_API int drtv_set_use_tiles(
    drtv_set* set, const void* file, size_t file_bytes, char* why, size_t why_bytes);

typedef struct drtv_sector_id {
    int32_t i;
    int32_t j;
} drtv_sector_id;
/* Nearest first, at most `room`. Returns how many it wrote. */
DRTV_API size_t drtv_wanted_sectors(const double camera[3],
                                    double radius_m,
                                    drtv_sector_id* out,
                                    size_t room);

/* ---- Light */

enum { DRTV_LITERAL = 0, DRTV_ACCURATE = 1 };

typedef struct drtv_group {
    const char* name; /* UTF-8, 0 at its end */
    float colour[3];
} drtv_group;

typedef struct drtv_light {
    int32_t mode;
    float sky[3][4]; /* SH by channel; drtv_constant_sky, drtv_gradient_sky or drtv_fit_sky fill it */
    float sun_irradiance[3];
    float sun_direction[3];
    float static_colour[3];
    float other_groups[3];
    const drtv_group* groups; /* only the first 64 count */
    size_t group_count;
} drtv_light;
/* Accurate, dark, static colour 1. */
DRTV_API drtv_light drtv_default_light(void);
DRTV_API void drtv_constant_sky(const float radiance[3], float sky[3][4]);
DRTV_API void drtv_gradient_sky(const float zenith[3],
                                const float horizon[3],
                                const float sun_side[3],
                                const float to_sun[3],
                                float sky[3][4]);
typedef void (*drtv_sky_radiance)(const float direction[3], float radiance[3], void* user);
DRTV_API void drtv_fit_sky(drtv_sky_radiance radiance, void* user, float sky[3][4]);
/* The light of drtv::default_day, accurate. For a day of your own, fill a light at each hour. */
DRTV_API drtv_light drtv_light_of_default_day(double hour);

typedef struct drtv_lamp {
    double position[3];
    float intensity[3]; /* flux / (4 pi) */
} drtv_lamp;
typedef struct drtv_share {
    drtv_sector_id sector;
    uint8_t probe;
    uint8_t reserved[7];
    double source[3];
    double light[3];
    float intensity[3];
    float reserved2;
} drtv_share;
enum { DRTV_SHARES_PER_LAMP = 8 };
/* Returns how many shares it wrote. There must be room for DRTV_SHARES_PER_LAMP. */
DRTV_API size_t drtv_split_light(const drtv_set* set, const drtv_lamp* lamp, drtv_share* shares);

/* ---- Relit probes */

typedef struct drtv_relit drtv_relit;

enum { DRTV_NOW = 0, DRTV_NEXT = 1 };
DRTV_API size_t drtv_relit_bytes(const drtv_limits* limits, int with_fade);
DRTV_API drtv_relit* drtv_relit_make(void* memory, size_t bytes, const drtv_limits* limits, int with_fade);
/* 1 where a colour of the sector or of an open sky would change by more than `step`, else 0; 0 where the
 * sector is not loaded. */
DRTV_API int drtv_relight_needed(
    const drtv_set* set, drtv_sector_id sector, const drtv_light* shown, const drtv_light* now, float step);
DRTV_API void drtv_relit_set_light(drtv_relit* relit, int shown, const drtv_light* light);
/* 0 where the sector is not loaded. */
DRTV_API int drtv_relit_sector(drtv_relit* relit,
                               const drtv_set* set,
                               int shown,
                               drtv_sector_id sector,
                               const drtv_light* light,
                               const drtv_share* shares,
                               size_t share_count);
DRTV_API void drtv_relit_set_fade(drtv_relit* relit, float share);
DRTV_API void drtv_relit_finish_fade(drtv_relit* relit);
/* Gives what is shown. Returns 0 where the sector is not relit or has no such probe. */
DRTV_API int drtv_relit_colours(const drtv_relit* relit,
                                const drtv_set* set,
                                drtv_sector_id sector,
                                uint32_t probe,
                                float basis_colours[4][3]);
/* The colours of an open sky, to be multiplied by drtv_sky_factor. */
DRTV_API void drtv_relit_fallback(const drtv_relit* relit, float basis_colours[4][3]);
/* The largest colour of all relit sectors and of the fallback, for drtv_suggest_scale. */
DRTV_API float drtv_relit_largest(const drtv_relit* relit, const drtv_set* set);

/* ---- Volumes */

typedef struct drtv_volume drtv_volume;

enum { DRTV_RGBA8 = 0, DRTV_RGBA8_SQRT = 1, DRTV_RGBA16F = 2 };
typedef struct drtv_volume_settings {
    int32_t size[3];
    float texel_m[3];
    int32_t encoding;
    int32_t borders;
    int32_t atlas;
    int32_t blur;
    int32_t outdoors;
} drtv_volume_settings;
DRTV_API drtv_volume_settings drtv_default_volume(void);

/* 0 where a setting is out of range. */
DRTV_API size_t drtv_volume_bytes(const drtv_volume_settings* settings, const drtv_limits* limits);
DRTV_API drtv_volume* drtv_volume_make(void* memory,
                                       size_t bytes,
                                       const drtv_volume_settings* settings,
                                       const drtv_limits* limits);
DRTV_API float drtv_suggest_scale(float largest, float current);
DRTV_API void drtv_volume_set_scale(drtv_volume* volume, float scale);
DRTV_API void drtv_volume_update(
    drtv_volume* volume, const drtv_set* set, const drtv_relit* relit, const double camera[3], int write_all);

typedef struct drtv_box {
    int32_t offset[3];
    int32_t size[3];
} drtv_box;
/* What the last update wrote. */
DRTV_API const drtv_box* drtv_volume_dirty(const drtv_volume* volume, size_t* count);
DRTV_API void drtv_volume_texture_size(const drtv_volume* volume, int32_t size[3]);
/* Texture k, 0 to 2; NULL for any other k. */
DRTV_API const void* drtv_volume_texels(const drtv_volume* volume, uint32_t k, size_t* bytes);

typedef struct drtv_shader_inputs {
    double snapped_camera[3];
    float uv_scale[3];
    float wrap_offset[3];
    float uvw_multiply[3];
    float uvw_add[3];
    float scale;
    float reserved;
} drtv_shader_inputs;
DRTV_API void drtv_volume_shader_inputs(const drtv_volume* volume, drtv_shader_inputs* inputs);

/* ---- Places */

enum { DRTV_INSIDE = 0, DRTV_FADING = 1, DRTV_SECTOR_MISSING = 2, DRTV_PROBE_MISSING = 3 };
enum { DRTV_NEAREST = 0, DRTV_TRILINEAR = 1 };

typedef struct drtv_ambient_place {
    double at[3];
    float normal[3];
    int32_t sampling;
    float offset_m;
    int32_t interiors;
    float interior_soft_m;
    float reserved;
} drtv_ambient_place;
/* The offset for surfaces; 0 is for what floats freely. */
#define DRTV_SURFACE_OFFSET_M 1.0f
/* Trilinear, no offset, interiors with a softness of 1 m, the normal up. */
DRTV_API drtv_ambient_place drtv_default_place(void);

typedef struct drtv_ambient {
    int32_t status;
    float interior; /* share of an interior's probe */
    float basis_colours[4][3];
    float colour[3];
    float reserved;
} drtv_ambient;
DRTV_API void drtv_ambient_at(const drtv_set* set,
                              const drtv_light* light,
                              const drtv_share* shares,
                              size_t share_count,
                              const drtv_ambient_place* place,
                              drtv_ambient* ambient);
/* The same from a volume; the place's sampling is ignored. */
DRTV_API void drtv_ambient_in(const drtv_volume* volume,
                              const drtv_set* set,
                              const drtv_light* light,
                              const drtv_share* shares,
                              size_t share_count,
                              const drtv_ambient_place* place,
                              drtv_ambient* ambient);
typedef struct drtv_interior {
    drtv_sector_id sector; /* of its probe */
    uint32_t probe;
    float share;
} drtv_interior;
/* 0 where no interior has a share; `interior` then is all 0. */
DRTV_API int drtv_interior_at(const drtv_set* set,
                              const double place[3],
                              float soft_m,
                              drtv_interior* interior);
DRTV_API float drtv_sky_factor(const drtv_set* set, const double place[3]);
DRTV_API void drtv_shade_ambient(int mode,
                                 const float basis_colours[4][3],
                                 const float normal[3],
                                 float colour[3]);

#ifdef __cplusplus
}
#endif

#endif
