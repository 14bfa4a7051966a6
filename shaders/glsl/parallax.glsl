// Generated from shaders/wgsl/parallax.wgsl by `cargo xtask gen`.
precision highp float;
precision highp int;

// Parallax mapping: intersects the view ray with a height field below (or above) the drawn surface.
//
// view: the unit direction to the eye in tangent space, by `to_tangent_space` of an orthonormal frame. uv_per_length: the increase of u
// per unit of length along the tangent, and of v along the bitangent, which is negative if v points down in the image, as in glTF.
//
// Steep parallax mapping and parallax occlusion mapping step along the ray. The caller writes the loop, because it samples the map:
//
//     whole = parallax_shift(view, depth, uv_per_length)
//     gap = map(uv), t = 0                                      map: 0 at the drawn surface, 1 at `depth` below it
//     repeat parallax_steps(view, fewest, most) times, with equal steps of t up to 1:
//         next_gap = map(uv + next_t * whole) - next_t          the height of the ray above the map
//         if next_gap <= 0: t = parallax_hit(t, gap, next_t, next_gap); break
//         t = next_t, gap = next_gap
//     result: uv + t * whole
//
// Steep parallax mapping uses t = next_t instead of parallax_hit.

// Parallax mapping with one step: the offset of the UVs for the height of the map at the pixel, in units of length, negative below the
// surface. It is not divided by view.z, which limits the offset at grazing angles.
// Source: T. Welsh, "Parallax Mapping with Offset Limiting", 2004.
vec2 parallax_offset(vec3 view, float height, vec2 uv_per_length) {
    return height * view.xy * uv_per_length;
}

// The offset of the UVs where the ray is `depth` below the drawn surface. view.z is clamped to at least 1/16.
vec2 parallax_shift(vec3 view, float depth, vec2 uv_per_length) {
    return -depth / max(view.z, 0.0625) * view.xy * uv_per_length;
}

// The number of steps for a ray: `fewest` from above, `most` at grazing angles.
float parallax_steps(vec3 view, float fewest, float most) {
    return mix(most, fewest, clamp(view.z, 0.0, 1.0));
}

// The t where the ray enters the height field between two steps, of which the first is above or at the map, the second below or at it.
// Source: N. Tatarchuk, "Dynamic Parallax Occlusion Mapping", I3D 2006.
float parallax_hit(float t, float gap, float next_t, float next_gap) {
    return mix(t, next_t, gap / max(gap - next_gap, 0.000001));
}
