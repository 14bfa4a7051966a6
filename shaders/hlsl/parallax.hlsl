// Generated from shaders/wgsl/parallax.wgsl by `cargo xtask gen`.

// Parallax mapping: where the eye's ray meets a surface that lies below (or above) the drawn one.
//
// view: the direction to the eye in tangent space, unit: `to_tangent_space` in a frame made orthonormal. uv_per_length: how much u
// grows per unit of length along the tangent, and v along the bitangent: negative where v counts down the image, as in glTF.
//
// Steep parallax and parallax occlusion mapping step along the ray; the loop is the caller's, since it samples the map:
//
//     whole = parallax_shift(view, depth, uv_per_length)
//     gap = map(uv), t = 0                                      map: 0 at the drawn surface, 1 at `depth` below it
//     as often as parallax_steps(view, fewest, most) says, by equal steps of t up to 1:
//         next_gap = map(uv + next_t * whole) - next_t          how far the ray is above the map
//         if next_gap <= 0: t = parallax_hit(t, gap, next_t, next_gap), and out
//         t = next_t, gap = next_gap
//     uv + t * whole
//
// Steep parallax mapping takes next_t itself.

// One step: the shift of UVs for the height of the map where the drawn surface is seen, in units of length, negative below.
// Not divided by view.z, so that flat views do not swim.
// Source: T. Welsh, "Parallax Mapping with Offset Limiting", 2004.
float2 parallax_offset(float3 view, float height, float2 uv_per_length) {
    return height * view.xy * uv_per_length;
}

// The shift of UVs where the ray is `depth` below the drawn surface. Views flatter than one in 16 count as that.
float2 parallax_shift(float3 view, float depth, float2 uv_per_length) {
    return -depth / max(view.z, 0.0625) * view.xy * uv_per_length;
}

// How many steps a ray deserves: the fewest seen from above, the most from the side.
float parallax_steps(float3 view, float fewest, float most) {
    return lerp(most, fewest, clamp(view.z, 0.0, 1.0));
}

// Where the ray enters the map, between two steps: t and gap before, not below the map, and after, not above it.
// Source: N. Tatarchuk, "Dynamic Parallax Occlusion Mapping", I3D 2006.
float parallax_hit(float t, float gap, float next_t, float next_gap) {
    return lerp(t, next_t, gap / max(gap - next_gap, 0.000001));
}
