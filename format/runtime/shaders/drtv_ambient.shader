// Ambient light from relit probes on the GPU (M. Gilabert and N. Stefanov, "Deferred Radiance Transfer Volumes:
// Global Illumination in Far Cry 3", GDC 2012; slides 33 to 60). docs/runtime.md says how it goes together; each
// function does what its namesake in the C++ does, and a test compares them.
//
// It binds nothing: textures are fetched by what you define before including it (in WGSL: functions of these
// names in small letters, anywhere in the module).
//
//     DRTV_FETCH(k, uvw)       vec4 of volume k (0 to 2), or of the atlas, filtered linearly, level 0
//     DRTV_FETCH_TILE(column)  vec2 of the texel (ivec2) of the tile texture: visibility, height over the camera
//
// Places are relative to the snapped camera (VolumeShaderInputs), subtracted in double on the CPU. Directions
// are in the world, z up, unit vectors. Light is linear RGB, E/pi: times the albedo it is radiance.

const int DRTV_LITERAL = 0;
const int DRTV_ACCURATE = 1;
const int DRTV_RGBA8 = 0;
const int DRTV_RGBA8_SQRT = 1;
const int DRTV_RGBA16F = 2;

// The four colours of a probe: towards the three upper basis directions, and downwards.
struct DrtvColours {
    vec3 b0;
    vec3 b1;
    vec3 b2;
    vec3 down;
};

// VolumeShaderInputs and VolumeSettings.
struct DrtvVolume {
    vec3 size;
    vec3 uv_scale;
    vec3 wrap_offset;
    vec3 uvw_multiply;
    vec3 uvw_add;
    float scale;
    int encoding;
    int atlas;  // 1: one texture, the three over one another along z
};

DrtvColours drtv_scaled(DrtvColours colours, float factor) {
    DrtvColours result;
    result.b0 = colours.b0 * factor;
    result.b1 = colours.b1 * factor;
    result.b2 = colours.b2 * factor;
    result.down = colours.down * factor;
    return result;
}

// a where the share is 0, b where it is 1.
DrtvColours drtv_mixed(DrtvColours a, DrtvColours b, float share) {
    DrtvColours result;
    result.b0 = mix(a.b0, b.b0, share);
    result.b1 = mix(a.b1, b.b1, share);
    result.b2 = mix(a.b2, b.b2, share);
    result.down = mix(a.down, b.down, share);
    return result;
}

// Weights of the four colours at a normal: basis_weights.
vec4 drtv_weights(int mode, vec3 normal) {
    const float d0 = -0.408248290463863 * normal.x - 0.707106781186548 * normal.y;
    const float d1 = -0.408248290463863 * normal.x + 0.707106781186548 * normal.y;
    const float d2 = 0.816496580927726 * normal.x;
    if (mode == DRTV_LITERAL) {
        const float up = 0.577350269189626 * normal.z;
        const float c0 = d0 + up;
        const float c1 = d1 + up;
        const float c2 = d2 + up;
        return vec4(c0 * clamp(c0, 0.0, 1.0), c1 * clamp(c1, 0.0, 1.0), c2 * clamp(c2, 0.0, 1.0), 0.5 - 0.5 * normal.z);
    }
    const float upper = (1.0 + normal.z) * 0.633974596215561;
    const float third = upper / 3.0;
    return vec4(third + d0, third + d1, third + d2, 1.0 - upper);
}

// shade_ambient. Also for particles and what is transparent (slide 54), with a probe's colours as constants.
vec3 drtv_shade(int mode, DrtvColours colours, vec3 normal) {
    const vec4 w = drtv_weights(mode, normal);
    const vec3 light = w.x * colours.b0 + w.y * colours.b1 + w.z * colours.b2 + w.w * colours.down;
    return max(light, vec3(0.0, 0.0, 0.0));
}

// Where the place lies in the window, 0 to 1 on each axis.
vec3 drtv_window_place(DrtvVolume volume, vec3 place) {
    return place * volume.uv_scale + vec3(0.5, 0.5, 0.5);
}

// How much of the volume counts: 1, falling over the window's last texel to 0, half a texel from its side. Volume::Sample::weight.
float drtv_window_weight(DrtvVolume volume, vec3 place) {
    const vec3 at = drtv_window_place(volume, place);
    const vec3 to_side = min(at, vec3(1.0, 1.0, 1.0) - at) * volume.size;
    return clamp(min(to_side.x, min(to_side.y, to_side.z)) - 0.5, 0.0, 1.0);
}

// Where the textures hold the place (slide 40, VolumeWrapOffset).
vec3 drtv_volume_uvw(DrtvVolume volume, vec3 place) {
    return fract(drtv_window_place(volume, place) + volume.wrap_offset) * volume.uvw_multiply + volume.uvw_add;
}

vec4 drtv_decoded(DrtvVolume volume, vec4 texel) {
    if (volume.encoding == DRTV_RGBA8) {
        return texel * volume.scale;
    }
    if (volume.encoding == DRTV_RGBA8_SQRT) {
        return texel * texel * volume.scale;
    }
    return texel;
}

vec4 drtv_volume_texel(DrtvVolume volume, int k, vec3 uvw) {
    vec3 at = uvw;
    if (volume.atlas == 1) {
        at.z = (uvw.z + float(k)) / 3.0;
    }
    return drtv_decoded(volume, DRTV_FETCH(k, at));
}

// What the volume holds at a place: Volume::sample. Counts with drtv_window_weight.
DrtvColours drtv_volume_colours(DrtvVolume volume, vec3 place) {
    const vec3 uvw = drtv_volume_uvw(volume, place);
    const vec4 t0 = drtv_volume_texel(volume, 0, uvw);
    const vec4 t1 = drtv_volume_texel(volume, 1, uvw);
    const vec4 t2 = drtv_volume_texel(volume, 2, uvw);
    DrtvColours colours;
    colours.b0 = t0.xyz;
    colours.b1 = t1.xyz;
    colours.b2 = t2.xyz;
    colours.down = vec3(t0.w, t1.w, t2.w);
    return colours;
}

// Tiles of sectors: one texture, in which sector (i, j) has the columns from 16 (i mod n), 16 (j mod n) on
// (TileTexture).
struct DrtvTiles {
    vec2 camera;  // column of the snapped camera, 0 to columns
    float columns;  // 16 n
    float camera_z;  // metres
};

float drtv_column_factor(DrtvTiles tiles, vec2 column, float z) {
    const vec2 wrapped = column - tiles.columns * floor(column / tiles.columns);
    const vec2 tile = DRTV_FETCH_TILE(ivec2(int(wrapped.x), int(wrapped.y)));
    const float above = clamp((z - tile.y) / 16.0, 0.0, 1.0);
    return 1.0 - (1.0 - tile.x) * (1.0 - above);
}

// What is left of an open sky's ambient light: SectorSet::sky_factor (slide 58).
float drtv_sky_factor(DrtvTiles tiles, vec3 place) {
    const vec2 at = place.xy / 4.0 + tiles.camera - vec2(0.5, 0.5);
    const vec2 low = floor(at);
    const vec2 above = at - low;
    const float z = place.z + tiles.camera_z;
    const float south = mix(drtv_column_factor(tiles, low, z), drtv_column_factor(tiles, low + vec2(1.0, 0.0), z), above.x);
    const float north = mix(drtv_column_factor(tiles, low + vec2(0.0, 1.0), z), drtv_column_factor(tiles, low + vec2(1.0, 1.0), z), above.x);
    return mix(south, north, above.y);
}

// The ambient light of a surface, interiors apart: the volume, and towards its sides and beyond the distance. `far`
// is RelitProbes::fallback. `at` is place + offset * geometric normal.
DrtvColours drtv_outdoors(DrtvVolume volume, DrtvTiles tiles, DrtvColours far, vec3 at) {
    const DrtvColours distant = drtv_scaled(far, drtv_sky_factor(tiles, at));
    const float weight = drtv_window_weight(volume, at);
    if (weight > 0.0) {
        return drtv_mixed(distant, drtv_volume_colours(volume, at), weight);
    }
    return distant;
}

// The same with an interior's share (0 to 1) of the four colours of its probe: ambient_in.
vec3 drtv_ambient(int mode, DrtvColours outdoors, DrtvColours indoors, float share, vec3 normal) {
    return drtv_shade(mode, drtv_mixed(outdoors, indoors, share), normal);
}

// ---- Views that show what the runtime does, for looking. Colours are 0 to 1.

// The centre of the texel that holds a place.
vec3 drtv_texel_centre(DrtvVolume volume, vec3 place) {
    const vec3 texel = floor(drtv_window_place(volume, place) * volume.size) + vec3(0.5, 0.5, 0.5);
    return (texel / volume.size - vec3(0.5, 0.5, 0.5)) / volume.uv_scale;
}

// What the probe of a place's texel alone would give, without a filter.
vec3 drtv_view_probe(DrtvVolume volume, int mode, vec3 place, vec3 normal) {
    return drtv_shade(mode, drtv_volume_colours(volume, drtv_texel_centre(volume, place)), normal);
}

// A colour for each probe: which texels one probe owns.
vec3 drtv_view_owner(DrtvVolume volume, vec3 place) {
    const vec3 uvw = drtv_volume_uvw(volume, drtv_texel_centre(volume, place));
    const vec4 texel = (drtv_volume_texel(volume, 0, uvw) + drtv_volume_texel(volume, 1, uvw)) / volume.scale;
    const vec3 mixed = vec3(dot(texel, vec4(1.3, 2.1, 2.9, 1.7)), dot(texel, vec4(2.7, 1.1, 1.9, 2.3)), dot(texel, vec4(1.6, 2.8, 1.2, 2.5)));
    return abs(fract(mixed) * 2.0 - vec3(1.0, 1.0, 1.0));
}

// The three upper weights as red, green and blue, brighter by the downward one; what is below 0 is dark.
vec3 drtv_view_weights(int mode, vec3 normal) {
    const vec4 w = max(drtv_weights(mode, normal), vec4(0.0, 0.0, 0.0, 0.0));
    return min(w.xyz + vec3(0.4 * w.w, 0.4 * w.w, 0.4 * w.w), vec3(1.0, 1.0, 1.0));
}

// Red where the distance lights, green where the volume does, blue by what the distance has lost to its tile.
vec3 drtv_view_fallback(DrtvVolume volume, DrtvTiles tiles, vec3 place) {
    const float weight = drtv_window_weight(volume, place);
    return vec3(1.0 - weight, weight, (1.0 - weight) * (1.0 - drtv_sky_factor(tiles, place)));
}

// Red where a texel is at its encoding's end, blue where it holds a 0; the texel's light else, grey.
vec3 drtv_view_clipped(DrtvVolume volume, vec3 place) {
    const DrtvColours held = drtv_volume_colours(volume, drtv_texel_centre(volume, place));
    const vec3 most = max(max(held.b0, held.b1), max(held.b2, held.down));
    const vec3 least = min(min(held.b0, held.b1), min(held.b2, held.down));
    float end = volume.scale;
    if (volume.encoding == DRTV_RGBA16F) {
        end = 65504.0;
    }
    if (max(most.x, max(most.y, most.z)) >= 0.9995 * end) {
        return vec3(1.0, 0.0, 0.0);
    }
    if (min(least.x, min(least.y, least.z)) <= 0.00001 * volume.scale) {
        return vec3(0.0, 0.0, 1.0);
    }
    const float grey = clamp((most.x + most.y + most.z) / (3.0 * volume.scale), 0.0, 1.0);
    return vec3(grey, grey, grey);
}

// From white, a texel just written, to black, one of 64 frames ago; of a texture of frame numbers that the game writes
// where Volume::dirty says.
vec3 drtv_view_age(float frames) {
    const float fresh = clamp(1.0 - frames / 64.0, 0.0, 1.0);
    return vec3(fresh, fresh * fresh, fresh * fresh);
}
