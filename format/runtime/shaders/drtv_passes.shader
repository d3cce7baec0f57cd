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
float drtv_mask_winding(bool front_facing, float mesh_distance, float surface_distance) {
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
vec2 drtv_mask_blur(ivec2 pixel, ivec2 axis, float pixels_per_metre, float soft) {
    const float shown = DRTV_FETCH_MASK(pixel).y;
    if (shown <= 0.0) {
        return vec2(0.0, shown);
    }
    const float metres_per_pixel = shown / pixels_per_metre;
    const float reach = 0.5 * soft / metres_per_pixel;
    const float radius = (floor(reach + 0.5) + 0.5) * metres_per_pixel;
    float sum = 0.0;
    float count = 0.0;
    for (int n = -8; n <= 8; n = n + 1) {
        const float moved = floor(float(n) * reach / 8.0 + 0.5);
        const vec2 tap = DRTV_FETCH_MASK(pixel + axis * int(moved));
        const float across = moved * metres_per_pixel;
        const float apart = tap.y - shown;
        if (across * across + apart * apart <= radius * radius) {
            sum = sum + clamp(tap.x, 0.0, 1.0);
            count = count + 1.0;
        }
    }
    return vec2(sum / max(count, 1.0), shown);
}

// How much a texel of the small buffer says of a surface: 1 where both are one flat surface. `apart`: their distances'
// difference, in twentieths.
float drtv_alike(vec3 texel_normal, vec3 normal, float apart) {
    const float turned = max(dot(texel_normal, normal), 0.0);
    const float squared = turned * turned;
    return squared * squared / (1.0 + apart * apart * apart * apart);
}

// The ambient buffer, upsampled: of the four texels around `at` (in texels of the small buffer, whose centres are at
// 1/2), those of the same surface. Where none is, the nearest in distance counts. Multiply it with SSAO, which darkens
// ambient light alone, then with the albedo.
vec3 drtv_upsampled(vec2 at, vec3 normal, float metres) {
    const vec2 inside = at - vec2(0.5, 0.5);
    const vec2 low = floor(inside);
    const vec2 above = inside - low;
    const ivec2 first = ivec2(int(low.x), int(low.y));
    vec3 sum = vec3(0.0, 0.0, 0.0);
    float weights = 0.0;
    for (int y = 0; y < 2; y = y + 1) {
        for (int x = 0; x < 2; x = x + 1) {
            const ivec2 texel = first + ivec2(x, y);
            const float share_x = abs(1.0 - float(x) - above.x);
            const float share_y = abs(1.0 - float(y) - above.y);
            const vec4 surface = DRTV_FETCH_SURFACE(texel);
            const float apart = (surface.w - metres) / (0.05 * metres);
            const float least = 0.0001 / (1.0 + apart * apart);
            const float weight = share_x * share_y * drtv_alike(surface.xyz, normal, apart) + least;
            sum = sum + weight * DRTV_FETCH_AMBIENT(texel).xyz;
            weights = weights + weight;
        }
    }
    return sum / weights;
}
