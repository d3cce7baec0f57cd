// As harness.glsl; the flags MANUAL, ATLAS and REPEAT are constants before it.
@group(0) @binding(0) var<storage, read> points: array<f32>;
@group(0) @binding(1) var<storage, read> numbers: array<f32>;
@group(0) @binding(2) var<storage, read_write> results: array<f32>;
@group(0) @binding(3) var volume0: texture_3d<f32>;
@group(0) @binding(4) var volume1: texture_3d<f32>;
@group(0) @binding(5) var volume2: texture_3d<f32>;
@group(0) @binding(6) var tile_texture: texture_2d<f32>;
@group(0) @binding(7) var linear_sampler: sampler;

fn texel_of(k: i32, at: vec3<i32>) -> vec4<f32> {
    if (k == 0) {
        return textureLoad(volume0, at, 0);
    }
    if (k == 1) {
        return textureLoad(volume1, at, 0);
    }
    return textureLoad(volume2, at, 0);
}

fn drtv_fetch(k_asked: i32, uvw: vec3<f32>) -> vec4<f32> {
    let k = select(k_asked, 0, ATLAS);
    if (MANUAL) {
        let size = vec3<i32>(textureDimensions(volume0));
        let at = uvw * vec3<f32>(size) - 0.5;
        let low = floor(at);
        let above = at - low;
        var sum = vec4<f32>(0.0);
        for (var n = 0; n < 8; n++) {
            let next = vec3<i32>(n & 1, (n >> 1) & 1, (n >> 2) & 1);
            let share = mix(1.0 - above, above, vec3<f32>(next));
            var place = vec3<i32>(low) + next;
            if (REPEAT) {
                place = (place + size) % size;
            } else {
                place = clamp(place, vec3<i32>(0), size - 1);
            }
            sum += share.x * share.y * share.z * texel_of(k, place);
        }
        return sum;
    }
    if (k == 0) {
        return textureSampleLevel(volume0, linear_sampler, uvw, 0.0);
    }
    if (k == 1) {
        return textureSampleLevel(volume1, linear_sampler, uvw, 0.0);
    }
    return textureSampleLevel(volume2, linear_sampler, uvw, 0.0);
}
fn drtv_fetch_tile(column: vec2<i32>) -> vec2<f32> {
    return textureLoad(tile_texture, column, 0).xy;
}
// HERE
fn three(n: i32) -> vec3<f32> {
    return vec3<f32>(numbers[n], numbers[n + 1], numbers[n + 2]);
}
fn colours_at(n: i32) -> DrtvColours {
    return DrtvColours(three(n), three(n + 3), three(n + 6), three(n + 9));
}

@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) thread: vec3<u32>) {
    let id = thread.x;
    if (id * 8 >= arrayLength(&points)) {
        return;
    }
    let volume = DrtvVolume(three(0), three(3), three(6), three(9), three(12), numbers[15], i32(numbers[16]), i32(numbers[17]));
    let tiles = DrtvTiles(vec2<f32>(numbers[18], numbers[19]), numbers[20], numbers[21]);
    let mode = i32(numbers[46]);
    let p = id * 8;
    let place = vec3<f32>(points[p], points[p + 1], points[p + 2]);
    let normal = vec3<f32>(points[p + 3], points[p + 4], points[p + 5]);
    let outdoors = drtv_outdoors(volume, tiles, colours_at(22), place);
    let colour = drtv_ambient(mode, outdoors, colours_at(34), points[p + 6], normal);
    let weight = drtv_window_weight(volume, place);
    let weights = drtv_weights(mode, normal);
    var held = vec4<f32>(0.0);
    if (weight > 0.0) {
        let there = drtv_volume_colours(volume, place);
        held = vec4<f32>(there.b0.x, there.b1.y, there.b2.z, there.down.x);
    }
    let inside = select(0.0, 1.0, weight >= 1.0);
    let probe = drtv_view_probe(volume, mode, place, normal);
    let owner = drtv_view_owner(volume, place);
    let shown = drtv_view_weights(mode, normal);
    let distance_share = drtv_view_fallback(volume, tiles, place);
    let clipped = drtv_view_clipped(volume, place);
    let age = drtv_view_age(80.0 * points[p + 6]);
    let views = vec3<f32>(0.125 * (probe.x + owner.x + owner.y + owner.z) * inside, shown.x + 2.0 * shown.y + 4.0 * shown.z + age.x + age.y,
        distance_share.x + 2.0 * distance_share.z + (clipped.x + 2.0 * clipped.z) * inside);
    let found = array<f32, 16>(colour.x, colour.y, colour.z, weight, drtv_sky_factor(tiles, place), views.x, views.y, views.z,
                               weights.x, weights.y, weights.z, weights.w, held.x, held.y, held.z, held.w);
    for (var n = 0u; n < 16; n++) {
        results[id * 16 + n] = found[n];
    }
}
