// As harness_passes.glsl.
@group(0) @binding(0) var<storage, read> points: array<f32>;
@group(0) @binding(1) var<storage, read> numbers: array<f32>;
@group(0) @binding(2) var<storage, read_write> results: array<f32>;
@group(0) @binding(3) var mask_texture: texture_2d<f32>;
@group(0) @binding(4) var ambient_texture: texture_2d<f32>;
@group(0) @binding(5) var surface_texture: texture_2d<f32>;

fn drtv_fetch_mask(pixel: vec2<i32>) -> vec2<f32> {
    return textureLoad(mask_texture, clamp(pixel, vec2<i32>(0), vec2<i32>(textureDimensions(mask_texture)) - 1), 0).xy;
}
fn drtv_fetch_ambient(pixel: vec2<i32>) -> vec4<f32> {
    return textureLoad(ambient_texture, clamp(pixel, vec2<i32>(0), vec2<i32>(textureDimensions(ambient_texture)) - 1), 0);
}
fn drtv_fetch_surface(pixel: vec2<i32>) -> vec4<f32> {
    return textureLoad(surface_texture, clamp(pixel, vec2<i32>(0), vec2<i32>(textureDimensions(surface_texture)) - 1), 0);
}
// HERE
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) thread: vec3<u32>) {
    let id = thread.x;
    if (id * 8 >= arrayLength(&points)) {
        return;
    }
    let p = id * 8;
    let pixel = vec2<i32>(i32(points[p]), i32(points[p + 1]));
    let along_x = drtv_mask_blur(pixel, vec2<i32>(1, 0), numbers[0], numbers[1]);
    let along_y = drtv_mask_blur(pixel, vec2<i32>(0, 1), numbers[0], numbers[1]);
    let normal = vec3<f32>(points[p + 4], points[p + 5], points[p + 6]);
    let metres = points[p + 7];
    let upsampled = drtv_upsampled(vec2<f32>(points[p + 2], points[p + 3]), normal, metres);
    let found = array<f32, 16>(along_x.x, along_x.y, along_y.x, along_y.y, upsampled.x, upsampled.y, upsampled.z, 0.0,
                               drtv_mask_winding(true, metres, 20.0), drtv_mask_winding(false, metres, 20.0), 0.0, 0.0,
                               0.0, 0.0, 0.0, 0.0);
    for (var n = 0u; n < 16; n++) {
        results[id * 16 + n] = found[n];
    }
}
