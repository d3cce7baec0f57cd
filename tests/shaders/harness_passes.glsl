// Asks drtv_passes at many pixels; HERE stands the include.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Points { float points[]; };
layout(std430, binding = 1) readonly buffer Numbers { float numbers[]; };
layout(std430, binding = 2) writeonly buffer Results { float results[]; };
layout(binding = 0) uniform sampler2D mask_texture;
layout(binding = 1) uniform sampler2D ambient_texture;
layout(binding = 2) uniform sampler2D surface_texture;

vec4 clamped(sampler2D from_texture, ivec2 pixel) {
    return texelFetch(from_texture, clamp(pixel, ivec2(0), textureSize(from_texture, 0) - 1), 0);
}
#define DRTV_FETCH_MASK(pixel) clamped(mask_texture, pixel).xy
#define DRTV_FETCH_AMBIENT(pixel) clamped(ambient_texture, pixel)
#define DRTV_FETCH_SURFACE(pixel) clamped(surface_texture, pixel)
// HERE
void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id * 8u >= uint(points.length()))
        return;
    uint p = id * 8u;
    ivec2 pixel = ivec2(int(points[p]), int(points[p + 1u]));
    vec2 along_x = drtv_mask_blur(pixel, ivec2(1, 0), numbers[0], numbers[1]);
    vec2 along_y = drtv_mask_blur(pixel, ivec2(0, 1), numbers[0], numbers[1]);
    vec3 normal = vec3(points[p + 4u], points[p + 5u], points[p + 6u]);
    vec3 upsampled = drtv_upsampled(vec2(points[p + 2u], points[p + 3u]), normal, points[p + 7u]);
    float metres = points[p + 7u];
    float found[16] = float[16](along_x.x, along_x.y, along_y.x, along_y.y, upsampled.x, upsampled.y, upsampled.z, 0.0,
                                drtv_mask_winding(true, metres, 20.0), drtv_mask_winding(false, metres, 20.0), 0.0, 0.0,
                                0.0, 0.0, 0.0, 0.0);
    for (int n = 0; n < 16; ++n)
        results[id * 16u + uint(n)] = found[n];
}
