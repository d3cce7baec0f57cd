// As harness.glsl.
StructuredBuffer<float> points : register(t4);
StructuredBuffer<float> numbers : register(t5);
RWStructuredBuffer<float> results : register(u6);
Texture3D<float4> volume0 : register(t0);
Texture3D<float4> volume1 : register(t1);
Texture3D<float4> volume2 : register(t2);
Texture2D<float4> tile_texture : register(t3);
SamplerState linear_sampler : register(s7);

float4 texel_of(int k, int3 at) {
    if (k == 0)
        return volume0.Load(int4(at, 0));
    if (k == 1)
        return volume1.Load(int4(at, 0));
    return volume2.Load(int4(at, 0));
}
float4 fetched(int k_asked, float3 uvw) {
    int k = k_asked;
#ifdef ATLAS
    k = 0;
#endif
#ifdef MANUAL
    uint width, height, depth;
    volume0.GetDimensions(width, height, depth);
    int3 size = int3(width, height, depth);
    float3 at = uvw * float3(size) - 0.5;
    float3 low = floor(at);
    float3 above = at - low;
    float4 sum = float4(0, 0, 0, 0);
    for (int n = 0; n < 8; ++n) {
        int3 next = int3(n & 1, (n >> 1) & 1, (n >> 2) & 1);
        float3 share = lerp(1.0 - above, above, float3(next));
        int3 place = int3(low) + next;
#ifdef REPEAT
        place = (place + size) % size;
#else
        place = clamp(place, int3(0, 0, 0), size - 1);
#endif
        sum += share.x * share.y * share.z * texel_of(k, place);
    }
    return sum;
#else
    if (k == 0)
        return volume0.SampleLevel(linear_sampler, uvw, 0);
    if (k == 1)
        return volume1.SampleLevel(linear_sampler, uvw, 0);
    return volume2.SampleLevel(linear_sampler, uvw, 0);
#endif
}
#define DRTV_FETCH(k, uvw) fetched(k, uvw)
#define DRTV_FETCH_TILE(column) tile_texture.Load(int3(column, 0)).xy
// HERE
float3 three(int n) { return float3(numbers[n], numbers[n + 1], numbers[n + 2]); }
DrtvColours colours_at(int n) {
    DrtvColours colours;
    colours.b0 = three(n);
    colours.b1 = three(n + 3);
    colours.b2 = three(n + 6);
    colours.down = three(n + 9);
    return colours;
}

[numthreads(64, 1, 1)] void main(uint3 thread : SV_DispatchThreadID) {
    uint count, stride;
    points.GetDimensions(count, stride);
    uint id = thread.x;
    if (id * 8 >= count)
        return;
    DrtvVolume volume;
    volume.size = three(0);
    volume.uv_scale = three(3);
    volume.wrap_offset = three(6);
    volume.uvw_multiply = three(9);
    volume.uvw_add = three(12);
    volume.scale = numbers[15];
    volume.encoding = int(numbers[16]);
    volume.atlas = int(numbers[17]);
    DrtvTiles tiles;
    tiles.camera = float2(numbers[18], numbers[19]);
    tiles.columns = numbers[20];
    tiles.camera_z = numbers[21];
    int mode = int(numbers[46]);
    uint p = id * 8;
    float3 place = float3(points[p], points[p + 1], points[p + 2]);
    float3 normal = float3(points[p + 3], points[p + 4], points[p + 5]);
    DrtvColours outdoors = drtv_outdoors(volume, tiles, colours_at(22), place);
    float3 colour = drtv_ambient(mode, outdoors, colours_at(34), points[p + 6], normal);
    float weight = drtv_window_weight(volume, place);
    float4 weights = drtv_weights(mode, normal);
    float4 held = float4(0, 0, 0, 0);
    if (weight > 0.0) {
        DrtvColours there = drtv_volume_colours(volume, place);
        held = float4(there.b0.x, there.b1.y, there.b2.z, there.down.x);
    }
    float inside = weight >= 1.0 ? 1.0 : 0.0;  // not in the window's outermost texels, which the C++ does not sample
    float3 probe = drtv_view_probe(volume, mode, place, normal);
    float3 owner = drtv_view_owner(volume, place);
    float3 shown = drtv_view_weights(mode, normal);
    float3 distance_share = drtv_view_fallback(volume, tiles, place);
    float3 clipped = drtv_view_clipped(volume, place);
    float3 age = drtv_view_age(80.0 * points[p + 6]);
    float3 views = float3(0.125 * (probe.x + owner.x + owner.y + owner.z) * inside, shown.x + 2.0 * shown.y + 4.0 * shown.z + age.x + age.y,
        distance_share.x + 2.0 * distance_share.z + (clipped.x + 2.0 * clipped.z) * inside);
    float found[16] = {colour.x, colour.y, colour.z, weight, drtv_sky_factor(tiles, place), views.x, views.y, views.z,
                       weights.x, weights.y, weights.z, weights.w, held.x, held.y, held.z, held.w};
    for (int n = 0; n < 16; ++n)
        results[id * 16 + uint(n)] = found[n];
}
