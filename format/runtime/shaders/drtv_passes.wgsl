// Made by make_shaders.py of drtv_passes.shader: change it there. SPDX-License-Identifier: MIT
// Passes in screen space around drtv_ambient (M. Gilabert and N. Stefanov, "Deferred Radiance Transfer Volumes: Global
// Illumination in Far Cry 3", GDC 2012; slides 39, 55, 56 and 59): where interiors are, and an ambient buffer of less
// than the screen's resolution. docs/runtime.md says how they go together.
//
// It binds nothing; pixels (ivec2) are fetched by what you define before including it, clamped to the picture (in WGSL:
// functions of these names in small letters):
//
//     DRTV_FETCH_MASK(pixel)     vec2: winding number or share, and the distance in metres of what the pixel shows
//     DRTV_FETCH_AMBIENT(pixel)  vec4 of the small buffer: ambient light, w is passed over
//     DRTV_FETCH_SURFACE(pixel)  vec4 of the small buffer: the normal, and the distance
//
// Distances are along the view ray, in metres.

// Interiors, first pass: draw the closed mesh of an interior (SectorView::interior_vertices) without culling and without
// depth test, and add what this gives to a float target that is cleared to 0. The sum is the winding number of the mesh
// around the place that the pixel asks at: at `surface_distance`, which is the surface's less the offset.
fn drtv_mask_winding(front_facing: bool, mesh_distance: f32, surface_distance: f32) -> f32 {
    if (mesh_distance < surface_distance) {
        return 0.0;
    }
    if (front_facing) {
        return -1.0;
    }
    return 1.0;
}

// Interiors, second and third pass, along (1, 0) and then (0, 1): gives the share of the interior, which goes from 0 to 1
// over `soft` metres across the mesh (clamp(1/2 + d / soft, 0, 1) where the mesh is flat, and 1 m is usual), and again
// the distance. `pixels_per_metre`: of the picture, at a distance of 1 m. Surfaces in front of and behind others do not
// mix, and what is seen at an angle fades over as much of its own length; a pixel without a distance has no share.
fn drtv_mask_blur(pixel: vec2<i32>, axis: vec2<i32>, pixels_per_metre: f32, soft: f32) -> vec2<f32> {
    let shown: f32 = drtv_fetch_mask(pixel).y;
    if (shown <= 0.0) {
        return vec2<f32>(0.0, shown);
    }
    let metres_per_pixel: f32 = shown / pixels_per_metre;
    let reach: f32 = 0.5 * soft / metres_per_pixel;
    let radius: f32 = (floor(reach + 0.5) + 0.5) * metres_per_pixel;
    var sum: f32 = 0.0;
    var count: f32 = 0.0;
    for (var n: i32 = -8; n <= 8; n = n + 1) {
        let moved: f32 = floor(f32(n) * reach / 8.0 + 0.5);
        let tap: vec2<f32> = drtv_fetch_mask(pixel + axis * i32(moved));
        let across: f32 = moved * metres_per_pixel;
        let apart: f32 = tap.y - shown;
        if (across * across + apart * apart <= radius * radius) {
            sum = sum + clamp(tap.x, 0.0, 1.0);
            count = count + 1.0;
        }
    }
    return vec2<f32>(sum / max(count, 1.0), shown);
}

// How much a texel of the small buffer says of a surface: 1 where both are one flat surface. `apart`: their distances'
// difference, in twentieths.
fn drtv_alike(texel_normal: vec3<f32>, normal: vec3<f32>, apart: f32) -> f32 {
    let turned: f32 = max(dot(texel_normal, normal), 0.0);
    let squared: f32 = turned * turned;
    return squared * squared / (1.0 + apart * apart * apart * apart);
}

// The ambient buffer, upsampled: of the four texels around `at` (in texels of the small buffer, whose centres are at
// 1/2), those of the same surface. Where none is, the nearest in distance counts. Multiply it with SSAO, which darkens
// ambient light alone, then with the albedo.
fn drtv_upsampled(at: vec2<f32>, normal: vec3<f32>, metres: f32) -> vec3<f32> {
    let inside: vec2<f32> = at - vec2<f32>(0.5, 0.5);
    let low: vec2<f32> = floor(inside);
    let above: vec2<f32> = inside - low;
    let first: vec2<i32> = vec2<i32>(i32(low.x), i32(low.y));
    var sum: vec3<f32> = vec3<f32>(0.0, 0.0, 0.0);
    var weights: f32 = 0.0;
    for (var y: i32 = 0; y < 2; y = y + 1) {
        for (var x: i32 = 0; x < 2; x = x + 1) {
            let texel: vec2<i32> = first + vec2<i32>(x, y);
            let share_x: f32 = abs(1.0 - f32(x) - above.x);
            let share_y: f32 = abs(1.0 - f32(y) - above.y);
            let surface: vec4<f32> = drtv_fetch_surface(texel);
            let apart: f32 = (surface.w - metres) / (0.05 * metres);
            let least: f32 = 0.0001 / (1.0 + apart * apart);
            let weight: f32 = share_x * share_y * drtv_alike(surface.xyz, normal, apart) + least;
            sum = sum + weight * drtv_fetch_ambient(texel).xyz;
            weights = weights + weight;
        }
    }
    return sum / weights;
}
