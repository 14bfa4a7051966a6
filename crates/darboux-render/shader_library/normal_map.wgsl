// Generated from shaders/wgsl/normal_map.wgsl by `cargo xtask gen`.

// Decodes the texels of normal maps, and blends normals. All vectors are in tangent space.
//
// Texels are as a sampler of an unsigned normalised format returns them, with channels from 0 to 1. Green must point in the direction of
// the bitangent: to the top of the image in glTF and OpenGL. Vectors need not be unit vectors unless a comment says so.

// The normal of a texel of three channels: 2 c - 1, as glTF specifies. No 8-bit value gives zero: the 128 of a flat texel gives 1/255. In
// exchange, inverting a channel is exact.
fn normal_from_texel(texel: vec3f) -> vec3f {
    return 2.0 * texel - vec3f(1.0, 1.0, 1.0);
}

// The same for 8-bit maps that encode zero as 128: (c - 128) / 127, where 0 counts as 1.
fn normal_from_texel_around_128(texel: vec3f) -> vec3f {
    return max((255.0 * texel - vec3f(128.0, 128.0, 128.0)) / 127.0, vec3f(-1.0, -1.0, -1.0));
}

// The unit normal of a texel of two channels, with z computed: red and green of BC5, or alpha and green of "DXT5nm".
fn normal_from_two_channels(texel: vec2f) -> vec3f {
    let xy: vec2f = 2.0 * texel - vec2f(1.0, 1.0);
    return vec3f(xy, sqrt(max(1.0 - xy.x * xy.x - xy.y * xy.y, 0.0)));
}

// The normal with another intensity. scale: normalTexture.scale of glTF in both components; negate the second for a map whose green
// channel points down.
fn scaled_normal(normal: vec3f, scale: vec2f) -> vec3f {
    return vec3f(scale * normal.xy, normal.z);
}

// Reoriented normal mapping: rotates the detail as the base is rotated from (0, 0, 1). Keeps the full strength of the detail.
// base and detail: unit vectors, base.z above -1. The result is a unit vector.
// Source: C. Barre-Brisebois and S. Hill, "Blending in Detail", 2012.
fn blended_normals_reoriented(base: vec3f, detail: vec3f) -> vec3f {
    let t: vec3f = vec3f(base.xy, base.z + 1.0);
    let u: vec3f = vec3f(-detail.x, -detail.y, detail.z);
    return dot(t, u) / t.z * t - u;
}

// Whiteout blend: adds the slopes, less where either normal is steep. Symmetric.
fn blended_normals_whiteout(base: vec3f, detail: vec3f) -> vec3f {
    return vec3f(base.xy + detail.xy, base.z * detail.z);
}

// UDN blend: cheaper than the whiteout blend, and flatter where the base is steep.
fn blended_normals_udn(base: vec3f, detail: vec3f) -> vec3f {
    return vec3f(base.xy + detail.xy, base.z);
}
