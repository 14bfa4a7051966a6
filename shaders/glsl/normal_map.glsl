// Generated from shaders/wgsl/normal_map.wgsl by `cargo xtask gen`.
precision highp float;
precision highp int;

// Normals from texels of normal maps, and their blends; all in tangent space.
//
// Texels come as a sampler of an unsigned normalized format gives them: channels from 0 to 1. Green must lean the way that the
// bitangent points: towards the top of the image in glTF and OpenGL. Nothing here needs to be unit, but where it says so.

// The normal of a texel of three channels: 2 c - 1. No 8-bit channel is zero then: the 128 of a flat texel leans by 1/255. That is
// what glTF and every API say, and inverting a channel stays exact.
vec3 normal_from_texel(vec3 texel) {
    return 2.0 * texel - vec3(1.0, 1.0, 1.0);
}

// The same for 8-bit maps whose writer took 128 for zero: (c - 128) / 127, and 0 as 1.
vec3 normal_from_texel_around_128(vec3 texel) {
    return max((255.0 * texel - vec3(128.0, 128.0, 128.0)) / 127.0, vec3(-1.0, -1.0, -1.0));
}

// The unit normal of a texel of two channels, z rebuilt: BC5's red and green, or alpha and green of "DXT5nm".
vec3 normal_from_two_channels(vec2 texel) {
    vec2 xy = 2.0 * texel - vec2(1.0, 1.0);
    return vec3(xy, sqrt(max(1.0 - xy.x * xy.x - xy.y * xy.y, 0.0)));
}

// The normal of a map at another intensity. `scale`: both components glTF's normalTexture.scale; the second negated for a map
// whose green leans the other way.
vec3 scaled_normal(vec3 normal, vec2 scale) {
    return vec3(scale * normal.xy, normal.z);
}

// Detail on a base, reoriented: the detail turned as the base turned from (0, 0, 1). Keeps the detail's strength everywhere.
// `base`, `detail`: unit, base.z above -1; so is the result.
// Source: C. Barre-Brisebois and S. Hill, "Blending in Detail", 2012.
vec3 blended_normals_reoriented(vec3 base, vec3 detail) {
    vec3 t = vec3(base.xy, base.z + 1.0);
    vec3 u = vec3(-detail.x, -detail.y, detail.z);
    return dot(t, u) / t.z * t - u;
}

// Whiteout blend: slopes added where both are flat, fading where either is steep; the same either way round.
vec3 blended_normals_whiteout(vec3 base, vec3 detail) {
    return vec3(base.xy + detail.xy, base.z * detail.z);
}

// UDN blend: cheaper, and flatter where the base is steep.
vec3 blended_normals_udn(vec3 base, vec3 detail) {
    return vec3(base.xy + detail.xy, base.z);
}
