// Asks every function of the include at many points; HERE stands the include. MANUAL filters by hand, in floats.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Points { float points[]; };
layout(std430, binding = 1) readonly buffer Numbers { float numbers[]; };
layout(std430, binding = 2) writeonly buffer Results { float results[]; };
layout(binding = 0) uniform sampler3D volume0;
layout(binding = 1) uniform sampler3D volume1;
layout(binding = 2) uniform sampler3D volume2;
layout(binding = 3) uniform sampler2D tile_texture;

vec4 texel_of(int k, ivec3 at) {
    return k == 0 ? texelFetch(volume0, at, 0) : k == 1 ? texelFetch(volume1, at, 0) : texelFetch(volume2, at, 0);
}
vec4 fetched(int k, vec3 uvw) {
#ifdef ATLAS
    k = 0;
#endif
#ifdef MANUAL
    ivec3 size = textureSize(volume0, 0);
    vec3 at = uvw * vec3(size) - 0.5;
    vec3 low = floor(at), above = at - low;
    vec4 sum = vec4(0.0);
    for (int n = 0; n < 8; ++n) {
        ivec3 next = ivec3(n & 1, n >> 1 & 1, n >> 2 & 1);
        vec3 share = mix(1.0 - above, above, vec3(next));
        ivec3 place = ivec3(low) + next;
#ifdef REPEAT
        place = (place + size) % size;
#else
        place = clamp(place, ivec3(0), size - 1);
#endif
        sum += share.x * share.y * share.z * texel_of(k, place);
    }
    return sum;
#else
    return k == 0 ? textureLod(volume0, uvw, 0.0) : k == 1 ? textureLod(volume1, uvw, 0.0) : textureLod(volume2, uvw, 0.0);
#endif
}
#define DRTV_FETCH(k, uvw) fetched(k, uvw)
#define DRTV_FETCH_TILE(column) texelFetch(tile_texture, column, 0).xy
// HERE
vec3 three(int n) { return vec3(numbers[n], numbers[n + 1], numbers[n + 2]); }
DrtvColours colours_at(int n) { return DrtvColours(three(n), three(n + 3), three(n + 6), three(n + 9)); }

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id * 8u >= uint(points.length()))
        return;
    DrtvVolume volume = DrtvVolume(three(0), three(3), three(6), three(9), three(12), numbers[15], int(numbers[16]), int(numbers[17]));
    DrtvTiles tiles = DrtvTiles(vec2(numbers[18], numbers[19]), numbers[20], numbers[21]);
    int mode = int(numbers[46]);
    uint p = id * 8u;
    vec3 place = vec3(points[p], points[p + 1u], points[p + 2u]);
    vec3 normal = vec3(points[p + 3u], points[p + 4u], points[p + 5u]);
    DrtvColours outdoors = drtv_outdoors(volume, tiles, colours_at(22), place);
    vec3 colour = drtv_ambient(mode, outdoors, colours_at(34), points[p + 6u], normal);
    float weight = drtv_window_weight(volume, place);
    vec4 weights = drtv_weights(mode, normal);
    vec4 held = vec4(0.0);
    if (weight > 0.0) {
        DrtvColours there = drtv_volume_colours(volume, place);
        held = vec4(there.b0.x, there.b1.y, there.b2.z, there.down.x);
    }
    float inside = weight >= 1.0 ? 1.0 : 0.0;  // not in the window's outermost texels, which the C++ does not sample
    vec3 probe = drtv_view_probe(volume, mode, place, normal);
    vec3 owner = drtv_view_owner(volume, place);
    vec3 shown = drtv_view_weights(mode, normal);
    vec3 distance_share = drtv_view_fallback(volume, tiles, place);
    vec3 clipped = drtv_view_clipped(volume, place);
    vec3 age = drtv_view_age(80.0 * points[p + 6u]);
    vec3 views = vec3(0.125 * (probe.x + owner.x + owner.y + owner.z) * inside, shown.x + 2.0 * shown.y + 4.0 * shown.z + age.x + age.y,
        distance_share.x + 2.0 * distance_share.z + (clipped.x + 2.0 * clipped.z) * inside);
    float found[16] = float[16](colour.x, colour.y, colour.z, weight, drtv_sky_factor(tiles, place), views.x, views.y, views.z,
                                weights.x, weights.y, weights.z, weights.w, held.x, held.y, held.z, held.w);
    for (int n = 0; n < 16; ++n)
        results[id * 16u + uint(n)] = found[n];
}
