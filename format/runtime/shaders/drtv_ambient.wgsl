// Made by make_shaders.py of drtv_ambient.shader: change it there. SPDX-License-Identifier: MIT
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

const DRTV_LITERAL: i32 = 0;
const DRTV_ACCURATE: i32 = 1;
const DRTV_RGBA8: i32 = 0;
const DRTV_RGBA8_SQRT: i32 = 1;
const DRTV_RGBA16F: i32 = 2;

// The four colours of a probe: towards the three upper basis directions, and downwards.
struct DrtvColours {
    b0: vec3<f32>,
    b1: vec3<f32>,
    b2: vec3<f32>,
    down: vec3<f32>,
}

// VolumeShaderInputs and VolumeSettings.
struct DrtvVolume {
    size: vec3<f32>,
    uv_scale: vec3<f32>,
    wrap_offset: vec3<f32>,
    uvw_multiply: vec3<f32>,
    uvw_add: vec3<f32>,
    scale: f32,
    encoding: i32,
    atlas: i32,  // 1: one texture, the three over one another along z
}

fn drtv_scaled(colours: DrtvColours, factor: f32) -> DrtvColours {
    var result: DrtvColours;
    result.b0 = colours.b0 * factor;
    result.b1 = colours.b1 * factor;
    result.b2 = colours.b2 * factor;
    result.down = colours.down * factor;
    return result;
}

// a where the share is 0, b where it is 1.
fn drtv_mixed(a: DrtvColours, b: DrtvColours, share: f32) -> DrtvColours {
    var result: DrtvColours;
    result.b0 = mix(a.b0, b.b0, share);
    result.b1 = mix(a.b1, b.b1, share);
    result.b2 = mix(a.b2, b.b2, share);
    result.down = mix(a.down, b.down, share);
    return result;
}

// Weights of the four colours at a normal: basis_weights.
fn drtv_weights(mode: i32, normal: vec3<f32>) -> vec4<f32> {
    let d0: f32 = -0.408248290463863 * normal.x - 0.707106781186548 * normal.y;
    let d1: f32 = -0.408248290463863 * normal.x + 0.707106781186548 * normal.y;
    let d2: f32 = 0.816496580927726 * normal.x;
    if (mode == DRTV_LITERAL) {
        let up: f32 = 0.577350269189626 * normal.z;
        let c0: f32 = d0 + up;
        let c1: f32 = d1 + up;
        let c2: f32 = d2 + up;
        return vec4<f32>(c0 * clamp(c0, 0.0, 1.0), c1 * clamp(c1, 0.0, 1.0), c2 * clamp(c2, 0.0, 1.0), 0.5 - 0.5 * normal.z);
    }
    let upper: f32 = (1.0 + normal.z) * 0.633974596215561;
    let third: f32 = upper / 3.0;
    return vec4<f32>(third + d0, third + d1, third + d2, 1.0 - upper);
}

// shade_ambient. Also for particles and what is transparent (slide 54), with a probe's colours as constants.
fn drtv_shade(mode: i32, colours: DrtvColours, normal: vec3<f32>) -> vec3<f32> {
    let w: vec4<f32> = drtv_weights(mode, normal);
    let light: vec3<f32> = w.x * colours.b0 + w.y * colours.b1 + w.z * colours.b2 + w.w * colours.down;
    return max(light, vec3<f32>(0.0, 0.0, 0.0));
}

// Where the place lies in the window, 0 to 1 on each axis.
fn drtv_window_place(volume: DrtvVolume, place: vec3<f32>) -> vec3<f32> {
    return place * volume.uv_scale + vec3<f32>(0.5, 0.5, 0.5);
}

// How much of the volume counts: 1, falling over the window's last texel to 0, half a texel from its side. Volume::Sample::weight.
fn drtv_window_weight(volume: DrtvVolume, place: vec3<f32>) -> f32 {
    let at: vec3<f32> = drtv_window_place(volume, place);
    let to_side: vec3<f32> = min(at, vec3<f32>(1.0, 1.0, 1.0) - at) * volume.size;
    return clamp(min(to_side.x, min(to_side.y, to_side.z)) - 0.5, 0.0, 1.0);
}

// Where the textures hold the place (slide 40, VolumeWrapOffset).
fn drtv_volume_uvw(volume: DrtvVolume, place: vec3<f32>) -> vec3<f32> {
    return fract(drtv_window_place(volume, place) + volume.wrap_offset) * volume.uvw_multiply + volume.uvw_add;
}

fn drtv_decoded(volume: DrtvVolume, texel: vec4<f32>) -> vec4<f32> {
    if (volume.encoding == DRTV_RGBA8) {
        return texel * volume.scale;
    }
    if (volume.encoding == DRTV_RGBA8_SQRT) {
        return texel * texel * volume.scale;
    }
    return texel;
}

fn drtv_volume_texel(volume: DrtvVolume, k: i32, uvw: vec3<f32>) -> vec4<f32> {
    var at: vec3<f32> = uvw;
    if (volume.atlas == 1) {
        at.z = (uvw.z + f32(k)) / 3.0;
    }
    return drtv_decoded(volume, drtv_fetch(k, at));
}

// What the volume holds at a place: Volume::sample. Counts with drtv_window_weight.
fn drtv_volume_colours(volume: DrtvVolume, place: vec3<f32>) -> DrtvColours {
    let uvw: vec3<f32> = drtv_volume_uvw(volume, place);
    let t0: vec4<f32> = drtv_volume_texel(volume, 0, uvw);
    let t1: vec4<f32> = drtv_volume_texel(volume, 1, uvw);
    let t2: vec4<f32> = drtv_volume_texel(volume, 2, uvw);
    var colours: DrtvColours;
    colours.b0 = t0.xyz;
    colours.b1 = t1.xyz;
    colours.b2 = t2.xyz;
    colours.down = vec3<f32>(t0.w, t1.w, t2.w);
    return colours;
}

// Tiles of sectors: one texture, in which sector (i, j) has the columns from 16 (i mod n), 16 (j mod n) on
// (TileTexture).
struct DrtvTiles {
    camera: vec2<f32>,  // column of the snapped camera, 0 to columns
    columns: f32,  // 16 n
    camera_z: f32,  // metres
}

fn drtv_column_factor(tiles: DrtvTiles, column: vec2<f32>, z: f32) -> f32 {
    let wrapped: vec2<f32> = column - tiles.columns * floor(column / tiles.columns);
    let tile: vec2<f32> = drtv_fetch_tile(vec2<i32>(i32(wrapped.x), i32(wrapped.y)));
    let above: f32 = clamp((z - tile.y) / 16.0, 0.0, 1.0);
    return 1.0 - (1.0 - tile.x) * (1.0 - above);
}

// What is left of an open sky's ambient light: SectorSet::sky_factor (slide 58).
fn drtv_sky_factor(tiles: DrtvTiles, place: vec3<f32>) -> f32 {
    let at: vec2<f32> = place.xy / 4.0 + tiles.camera - vec2<f32>(0.5, 0.5);
    let low: vec2<f32> = floor(at);
    let above: vec2<f32> = at - low;
    let z: f32 = place.z + tiles.camera_z;
    let south: f32 = mix(drtv_column_factor(tiles, low, z), drtv_column_factor(tiles, low + vec2<f32>(1.0, 0.0), z), above.x);
    let north: f32 = mix(drtv_column_factor(tiles, low + vec2<f32>(0.0, 1.0), z), drtv_column_factor(tiles, low + vec2<f32>(1.0, 1.0), z), above.x);
    return mix(south, north, above.y);
}

// The ambient light of a surface, interiors apart: the volume, and towards its sides and beyond the distance. `far`
// is RelitProbes::fallback. `at` is place + offset * geometric normal.
fn drtv_outdoors(volume: DrtvVolume, tiles: DrtvTiles, far: DrtvColours, at: vec3<f32>) -> DrtvColours {
    let distant: DrtvColours = drtv_scaled(far, drtv_sky_factor(tiles, at));
    let weight: f32 = drtv_window_weight(volume, at);
    if (weight > 0.0) {
        return drtv_mixed(distant, drtv_volume_colours(volume, at), weight);
    }
    return distant;
}

// The same with an interior's share (0 to 1) of the four colours of its probe: ambient_in.
fn drtv_ambient(mode: i32, outdoors: DrtvColours, indoors: DrtvColours, share: f32, normal: vec3<f32>) -> vec3<f32> {
    return drtv_shade(mode, drtv_mixed(outdoors, indoors, share), normal);
}

// ---- Views that show what the runtime does, for looking. Colours are 0 to 1.

// The centre of the texel that holds a place.
fn drtv_texel_centre(volume: DrtvVolume, place: vec3<f32>) -> vec3<f32> {
    let texel: vec3<f32> = floor(drtv_window_place(volume, place) * volume.size) + vec3<f32>(0.5, 0.5, 0.5);
    return (texel / volume.size - vec3<f32>(0.5, 0.5, 0.5)) / volume.uv_scale;
}

// What the probe of a place's texel alone would give, without a filter.
fn drtv_view_probe(volume: DrtvVolume, mode: i32, place: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return drtv_shade(mode, drtv_volume_colours(volume, drtv_texel_centre(volume, place)), normal);
}

// A colour for each probe: which texels one probe owns.
fn drtv_view_owner(volume: DrtvVolume, place: vec3<f32>) -> vec3<f32> {
    let uvw: vec3<f32> = drtv_volume_uvw(volume, drtv_texel_centre(volume, place));
    let texel: vec4<f32> = (drtv_volume_texel(volume, 0, uvw) + drtv_volume_texel(volume, 1, uvw)) / volume.scale;
    let mixed: vec3<f32> = vec3<f32>(dot(texel, vec4<f32>(1.3, 2.1, 2.9, 1.7)), dot(texel, vec4<f32>(2.7, 1.1, 1.9, 2.3)), dot(texel, vec4<f32>(1.6, 2.8, 1.2, 2.5)));
    return abs(fract(mixed) * 2.0 - vec3<f32>(1.0, 1.0, 1.0));
}

// The three upper weights as red, green and blue, brighter by the downward one; what is below 0 is dark.
fn drtv_view_weights(mode: i32, normal: vec3<f32>) -> vec3<f32> {
    let w: vec4<f32> = max(drtv_weights(mode, normal), vec4<f32>(0.0, 0.0, 0.0, 0.0));
    return min(w.xyz + vec3<f32>(0.4 * w.w, 0.4 * w.w, 0.4 * w.w), vec3<f32>(1.0, 1.0, 1.0));
}

// Red where the distance lights, green where the volume does, blue by what the distance has lost to its tile.
fn drtv_view_fallback(volume: DrtvVolume, tiles: DrtvTiles, place: vec3<f32>) -> vec3<f32> {
    let weight: f32 = drtv_window_weight(volume, place);
    return vec3<f32>(1.0 - weight, weight, (1.0 - weight) * (1.0 - drtv_sky_factor(tiles, place)));
}

// Red where a texel is at its encoding's end, blue where it holds a 0; the texel's light else, grey.
fn drtv_view_clipped(volume: DrtvVolume, place: vec3<f32>) -> vec3<f32> {
    let held: DrtvColours = drtv_volume_colours(volume, drtv_texel_centre(volume, place));
    let most: vec3<f32> = max(max(held.b0, held.b1), max(held.b2, held.down));
    let least: vec3<f32> = min(min(held.b0, held.b1), min(held.b2, held.down));
    var end: f32 = volume.scale;
    if (volume.encoding == DRTV_RGBA16F) {
        end = 65504.0;
    }
    if (max(most.x, max(most.y, most.z)) >= 0.9995 * end) {
        return vec3<f32>(1.0, 0.0, 0.0);
    }
    if (min(least.x, min(least.y, least.z)) <= 0.00001 * volume.scale) {
        return vec3<f32>(0.0, 0.0, 1.0);
    }
    let grey: f32 = clamp((most.x + most.y + most.z) / (3.0 * volume.scale), 0.0, 1.0);
    return vec3<f32>(grey, grey, grey);
}

// From white, a texel just written, to black, one of 64 frames ago; of a texture of frame numbers that the game writes
// where Volume::dirty says.
fn drtv_view_age(frames: f32) -> vec3<f32> {
    let fresh: f32 = clamp(1.0 - frames / 64.0, 0.0, 1.0);
    return vec3<f32>(fresh, fresh * fresh, fresh * fresh);
}
