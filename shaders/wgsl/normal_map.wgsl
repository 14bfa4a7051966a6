// Normals from texels of normal maps, and their blends; all in tangent space.
//
// Texels come as a sampler of an unsigned normalized format gives them: channels from 0 to 1. Green must lean the way that the
// bitangent points: towards the top of the image in glTF and OpenGL. Nothing here needs to be unit, but where it says so.

// The normal of a texel of three channels: 2 c - 1. No 8-bit channel is zero then: the 128 of a flat texel leans by 1/255. That is
// what glTF and every API say, and inverting a channel stays exact.
fn normal_from_texel(texel: vec3f) -> vec3f {
    return 2.0 * texel - vec3f(1.0, 1.0, 1.0);
}

// The same for 8-bit maps whose writer took 128 for zero: (c - 128) / 127, and 0 as 1.
fn normal_from_texel_around_128(texel: vec3f) -> vec3f {
    return max((255.0 * texel - vec3f(128.0, 128.0, 128.0)) / 127.0, vec3f(-1.0, -1.0, -1.0));
}

// The unit normal of a texel of two channels, z rebuilt: BC5's red and green, or alpha and green of "DXT5nm".
fn normal_from_two_channels(texel: vec2f) -> vec3f {
    let xy: vec2f = 2.0 * texel - vec2f(1.0, 1.0);
    return vec3f(xy, sqrt(max(1.0 - xy.x * xy.x - xy.y * xy.y, 0.0)));
}

// The normal of a map at another intensity. `scale`: both components glTF's normalTexture.scale; the second negated for a map
// whose green leans the other way.
fn scaled_normal(normal: vec3f, scale: vec2f) -> vec3f {
    return vec3f(scale * normal.xy, normal.z);
}

// Detail on a base, reoriented: the detail turned as the base turned from (0, 0, 1). Keeps the detail's strength everywhere.
// `base`, `detail`: unit, base.z above -1; so is the result.
// Source: C. Barre-Brisebois and S. Hill, "Blending in Detail", 2012.
fn blended_normals_reoriented(base: vec3f, detail: vec3f) -> vec3f {
    let t: vec3f = vec3f(base.xy, base.z + 1.0);
    let u: vec3f = vec3f(-detail.x, -detail.y, detail.z);
    return dot(t, u) / t.z * t - u;
}

// Whiteout blend: slopes added where both are flat, fading where either is steep; the same either way round.
fn blended_normals_whiteout(base: vec3f, detail: vec3f) -> vec3f {
    return vec3f(base.xy + detail.xy, base.z * detail.z);
}

// UDN blend: cheaper, and flatter where the base is steep.
fn blended_normals_udn(base: vec3f, detail: vec3f) -> vec3f {
    return vec3f(base.xy + detail.xy, base.z);
}
