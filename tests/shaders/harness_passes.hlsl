// As harness_passes.glsl.
StructuredBuffer<float> points : register(t4);
StructuredBuffer<float> numbers : register(t5);
RWStructuredBuffer<float> results : register(u6);
Texture2D<float4> mask_texture : register(t0);
Texture2D<float4> ambient_texture : register(t1);
Texture2D<float4> surface_texture : register(t2);

float4 clamped(Texture2D<float4> from_texture, int2 pixel) {
    uint width, height;
    from_texture.GetDimensions(width, height);
    return from_texture.Load(int3(clamp(pixel, int2(0, 0), int2(width, height) - 1), 0));
}
#define DRTV_FETCH_MASK(pixel) clamped(mask_texture, pixel).xy
#define DRTV_FETCH_AMBIENT(pixel) clamped(ambient_texture, pixel)
#define DRTV_FETCH_SURFACE(pixel) clamped(surface_texture, pixel)
// HERE
[numthreads(64, 1, 1)] void main(uint3 thread : SV_DispatchThreadID) {
    uint count, stride;
    points.GetDimensions(count, stride);
    uint id = thread.x;
    if (id * 8 >= count)
        return;
    uint p = id * 8;
    int2 pixel = int2(int(points[p]), int(points[p + 1]));
    float2 along_x = drtv_mask_blur(pixel, int2(1, 0), numbers[0], numbers[1]);
    float2 along_y = drtv_mask_blur(pixel, int2(0, 1), numbers[0], numbers[1]);
    float3 normal = float3(points[p + 4], points[p + 5], points[p + 6]);
    float metres = points[p + 7];
    float3 upsampled = drtv_upsampled(float2(points[p + 2], points[p + 3]), normal, metres);
    float found[16] = {along_x.x, along_x.y, along_y.x, along_y.y, upsampled.x, upsampled.y, upsampled.z, 0,
                       drtv_mask_winding(true, metres, 20.0), drtv_mask_winding(false, metres, 20.0), 0, 0, 0, 0, 0, 0};
    for (int n = 0; n < 16; ++n)
        results[id * 16 + uint(n)] = found[n];
}
