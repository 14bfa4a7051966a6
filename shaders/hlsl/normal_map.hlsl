// Generated from shaders/wgsl/normal_map.wgsl by `cargo xtask gen`.

// Normals from texels of normal maps, and their blends; all in tangent space.
//
// Texels come as a sampler of an unsigned normalized format gives them: channels from 0 to 1. Green must lean the way that the
// bitangent points: towards the top of the image in glTF and OpenGL. Nothing here needs to be unit, but where it says so.

// The normal of a texel of three channels: 2 c - 1. No 8-bit channel is zero then: the 128 of a flat texel leans by 1/255. That is
// what glTF and every API say, and inverting a channel stays exact.
float3 normal_from_texel(float3 texel) {
    return 2.0 * texel - float3(1.0, 1.0, 1.0);
}

// The same for 8-bit maps whose writer took 128 for zero: (c - 128) / 127, and 0 as 1.
float3 normal_from_texel_around_128(float3 texel) {
    return max((255.0 * texel - float3(128.0, 128.0, 128.0)) / 127.0, float3(-1.0, -1.0, -1.0));
}

// The unit normal of a texel of two channels, z rebuilt: BC5's red and green, or alpha and green of "DXT5nm".
float3 normal_from_two_channels(float2 texel) {
    float2 xy = 2.0 * texel - float2(1.0, 1.0);
    return float3(xy, sqrt(max(1.0 - xy.x * xy.x - xy.y * xy.y, 0.0)));
}

// The normal of a map at another intensity. `scale`: both components glTF's normalTexture.scale; the second negated for a map
// whose green leans the other way.
float3 scaled_normal(float3 normal, float2 scale) {
    return float3(scale * normal.xy, normal.z);
}

// Detail on a base, reoriented: the detail turned as the base turned from (0, 0, 1). Keeps the detail's strength everywhere.
// `base`, `detail`: unit, base.z above -1; so is the result.
// Source: C. Barre-Brisebois and S. Hill, "Blending in Detail", 2012.
float3 blended_normals_reoriented(float3 base, float3 detail) {
    float3 t = float3(base.xy, base.z + 1.0);
    float3 u = float3(-detail.x, -detail.y, detail.z);
    return dot(t, u) / t.z * t - u;
}

// Whiteout blend: slopes added where both are flat, fading where either is steep; the same either way round.
float3 blended_normals_whiteout(float3 base, float3 detail) {
    return float3(base.xy + detail.xy, base.z * detail.z);
}

// UDN blend: cheaper, and flatter where the base is steep.
float3 blended_normals_udn(float3 base, float3 detail) {
    return float3(base.xy + detail.xy, base.z);
}
