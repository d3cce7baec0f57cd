/* A game in C11: c_user FILE X Y Z prints status, colour and what a volume holds there, as one line. */
#include <drtv/drtv.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void* memory_of(size_t bytes) {
    return bytes == 0 ? NULL : aligned_alloc(16, (bytes + 15) / 16 * 16);
}

int main(int argc, char** argv) {
    if (argc != 5 || drtv_abi() != DRTV_ABI)
        return 1;
    FILE* file = fopen(argv[1], "rb");
    void* bytes = memory_of(1 << 20);
    const size_t count = file == NULL ? 0 : fread(bytes, 1, 1 << 20, file);

    drtv_limits limits = drtv_default_limits();
    limits.sectors = 4;
    limits.probes = 4 * 255;
    limits.tiles = 16;
    const size_t set_bytes = drtv_set_bytes(&limits);
    void* set_memory = memory_of(set_bytes);
    if (drtv_set_make(set_memory, set_bytes - 1, &limits) != NULL ||
        drtv_set_make((char*)set_memory + 4, set_bytes, &limits) != NULL)
        return 2;
    drtv_set* set = drtv_set_make(set_memory, set_bytes, &limits);
    char why[40];
    if (drtv_set_load(set, "no file", 7, why, sizeof why) != DRTV_UNREADABLE || strlen(why) != sizeof why - 1)
        return 3;
    if (drtv_set_load(set, bytes, count, why, sizeof why) != DRTV_LOADED) {
        printf("%s\n", why);
        return 4;
    }

    drtv_light light = drtv_default_light();
    const float zenith[3] = {0.2f, 0.4f, 0.9f}, horizon[3] = {0.5f, 0.6f, 0.7f}, side[3] = {0.3f, 0.2f, 0.1f};
    const float to_sun[3] = {3, 4, 12};
    drtv_gradient_sky(zenith, horizon, side, to_sun, light.sky);
    for (int c = 0; c < 3; ++c) {
        light.sun_irradiance[c] = 2;
        light.sun_direction[c] = to_sun[c];
    }
    const drtv_group groups[1] = {{"lanterns", {1, 2, 3}}};
    light.groups = groups;
    light.group_count = 1;

    drtv_ambient_place place = drtv_default_place();
    for (int axis = 0; axis < 3; ++axis)
        place.at[axis] = atof(argv[2 + axis]);
    const drtv_lamp lamp = {{place.at[0], place.at[1], place.at[2]}, {1, 2, 3}};
    drtv_share shares[DRTV_SHARES_PER_LAMP];
    const size_t share_count = drtv_split_light(set, &lamp, shares);
    drtv_ambient ambient;
    drtv_ambient_at(set, &light, shares, share_count, &place, &ambient);

    const size_t relit_bytes = drtv_relit_bytes(&limits, 0);
    void* relit_memory = memory_of(relit_bytes);
    drtv_relit* relit = drtv_relit_make(relit_memory, relit_bytes, &limits, 0);
    drtv_volume_settings settings = drtv_default_volume();
    settings.size[0] = 1;
    if (drtv_volume_bytes(&settings, &limits) != 0)
        return 5;
    settings.size[0] = 32;
    settings.encoding = DRTV_RGBA16F;
    settings.outdoors = 1;
    const size_t volume_bytes = drtv_volume_bytes(&settings, &limits);
    void* volume_memory = memory_of(volume_bytes);
    drtv_volume* volume = drtv_volume_make(volume_memory, volume_bytes, &settings, &limits);
    drtv_relit_set_light(relit, DRTV_NOW, &light);
    const drtv_sector_id golden = {-1, 2}, missing = {5, 5};
    if (drtv_relit_sector(relit, set, DRTV_NOW, golden, &light, shares, share_count) != 1 ||
        drtv_relit_sector(relit, set, DRTV_NOW, missing, &light, NULL, 0) != 0)
        return 6;
    drtv_light brighter = light;
    brighter.sun_irradiance[1] += 1;
    if (drtv_relight_needed(set, golden, &light, &light, 0) != 0 || drtv_relight_needed(set, golden, &light, &brighter, 1e-3f) != 1)
        return 12;
    drtv_volume_update(volume, set, relit, place.at, 0);
    size_t boxes = 0, texture_bytes = 0;
    const drtv_box* dirty = drtv_volume_dirty(volume, &boxes);
    const void* texels = drtv_volume_texels(volume, 2, &texture_bytes);
    drtv_shader_inputs inputs;
    drtv_volume_shader_inputs(volume, &inputs);
    if (boxes != 1 || dirty[0].size[0] != 34 || texels == NULL || drtv_volume_texels(volume, 3, &texture_bytes) != NULL ||
        texture_bytes != 34u * 98 * 18 * 8 || inputs.scale != 1 || !(drtv_relit_largest(relit, set) > 0))
        return 7;
    printf("%d %.9g %.9g %.9g\n", ambient.status, ambient.colour[0], ambient.colour[1], ambient.colour[2]);
    place.offset_m = 1;
    drtv_ambient_in(volume, set, &light, shares, share_count, &place, &ambient);
    printf("%d %.9g %.9g %.9g\n", ambient.status, ambient.colour[0], ambient.colour[1], ambient.colour[2]);

    /* An interior alone, and the distance alone, by hand. */
    float colours[4][3], colour[3];
    drtv_interior interior;
    place.at[2] += 1;
    if (drtv_interior_at(set, place.at, 1, &interior) && interior.share == 1) {
        if (!drtv_relit_colours(relit, set, interior.sector, interior.probe, colours))
            return 8;
        for (int n = 0; n < 12; ++n) { /* relit colours are halves, 65504 at most */
            const float found = colours[n / 3][n % 3], there = ambient.basis_colours[n / 3][n % 3];
            const float expected = there < 65504 ? there : 65504;
            if (found < 0.999f * expected || found > 1.001f * expected)
                return 9;
        }
        drtv_shade_ambient(light.mode, (const float(*)[3])colours, place.normal, colour);
        if (!(colour[0] > 0))
            return 9;
    }
    const int is_indoors = interior.share == 1;
    drtv_relit_fallback(relit, colours);
    const float factor = drtv_sky_factor(set, place.at);
    if (ambient.status == DRTV_SECTOR_MISSING && ambient.interior == 0 &&
        !(ambient.basis_colours[0][1] > 0.99f * factor * colours[0][1] && ambient.basis_colours[0][1] < 1.01f * factor * colours[0][1]))
        return 10;
    const drtv_light noon = drtv_light_of_default_day(12);
    if (!(noon.sun_irradiance[0] > 100 && noon.sun_direction[2] > 0.9f) || drtv_relit_colours(relit, set, missing, 0, colours))
        return 11;
    printf("%d\n", is_indoors);
    drtv_set_drop(set, -1, 2);
    drtv_set_retire(set);
    return drtv_set_has(set, -1, 2);
}
