// Generated from shaders/wgsl/normal_map.wgsl by `cargo xtask gen`.

// Decodes the texels of normal maps, and blends normals. All vectors are in tangent space.
//
// Texels are as a sampler of an unsigned normalised format returns them, with channels from 0 to 1. Green must point in the direction of
// the bitangent: to the top of the image in glTF and OpenGL. Vectors need not be unit vectors unless a comment says so.

// The normal of a texel of three channels: 2 c - 1, as glTF specifies. No 8-bit value gives zero: the 128 of a flat texel gives 1/255. In
// exchange, inverting a channel is exact.
float3 normal_from_texel(float3 texel) {
    return 2.0 * texel - float3(1.0, 1.0, 1.0);
}

// The same for 8-bit maps that encode zero as 128: (c - 128) / 127, where 0 counts as 1.
float3 normal_from_texel_around_128(float3 texel) {
    return max((255.0 * texel - float3(128.0, 128.0, 128.0)) / 127.0, float3(-1.0, -1.0, -1.0));
}

// The unit normal of a texel of two channels, with z computed: red and green of BC5, or alpha and green of "DXT5nm".
float3 normal_from_two_channels(float2 texel) {
    float2 xy = 2.0 * texel - float2(1.0, 1.0);
    return float3(xy, sqrt(max(1.0 - xy.x * xy.x - xy.y * xy.y, 0.0)));
}

// The normal with another intensity. scale: normalTexture.scale of glTF in both components; negate the second for a map whose green
// channel points down.
float3 scaled_normal(float3 normal, float2 scale) {
    return float3(scale * normal.xy, normal.z);
}

// Reoriented normal mapping: rotates the detail as the base is rotated from (0, 0, 1). Keeps the full strength of the detail.
// base and detail: unit vectors, base.z above -1. The result is a unit vector.
// Source: C. Barre-Brisebois and S. Hill, "Blending in Detail", 2012.
float3 blended_normals_reoriented(float3 base, float3 detail) {
    float3 t = float3(base.xy, base.z + 1.0);
    float3 u = float3(-detail.x, -detail.y, detail.z);
    return dot(t, u) / t.z * t - u;
}

// Whiteout blend: adds the slopes, less where either normal is steep. Symmetric.
float3 blended_normals_whiteout(float3 base, float3 detail) {
    return float3(base.xy + detail.xy, base.z * detail.z);
}

// UDN blend: cheaper than the whiteout blend, and flatter where the base is steep.
float3 blended_normals_udn(float3 base, float3 detail) {
    return float3(base.xy + detail.xy, base.z);
}
