// Generated from shaders/wgsl/triplanar.wgsl by `cargo xtask gen`.
precision highp float;
precision highp int;

// Triplanar mapping: projects a normal map along the three axes, for surfaces without UVs.
// Requires frame and normal_map.
//
// For each axis, compute the UVs with `projected_uv` in the frame of the axis, sample the map there and decode the texel. Then pass the three
// normals to `triplanar_normal`.

// The frames of the three sides that the normal faces. Seen from outside, u points right and v up. Up is y; on the top -z, on the bottom z.
TangentFrame projection_frame_x(vec3 normal) {
    float side = 1.0;
    if (normal.x < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(vec3(side, 0.0, 0.0), vec3(0.0, 0.0, -side), vec3(0.0, 1.0, 0.0));
}

TangentFrame projection_frame_y(vec3 normal) {
    float side = 1.0;
    if (normal.y < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(vec3(0.0, side, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, -side));
}

TangentFrame projection_frame_z(vec3 normal) {
    float side = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(vec3(0.0, 0.0, side), vec3(side, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
}

// The UV of a position in the projection of a frame, with one repetition per unit of length. Negate v if it points down in the image.
vec2 projected_uv(TangentFrame frame, vec3 position) {
    return to_tangent_space(frame, position).xy;
}

// The weights of the three projections, whose sum is 1. sharpness: at least 1; 4 is common, higher values narrow the transitions.
vec3 triplanar_weights(vec3 normal, float sharpness) {
    vec3 size = abs(normal);
    float largest = max(max(size.x, size.y), size.z);
    vec3 weights = pow(size / largest, vec3(sharpness, sharpness, sharpness));
    return weights / (weights.x + weights.y + weights.z);
}

// The normal of one projection in the space of the surface: the whiteout blend of texel and surface normal in the projection's frame.
vec3 projected_normal(TangentFrame frame, vec3 normal, vec3 texel_normal) {
    vec3 blended = blended_normals_whiteout(to_tangent_space(frame, normal), texel_normal);
    return from_tangent_space(frame, blended);
}

// The unit normal of the surface, from the decoded texels of the three projections.
vec3 triplanar_normal(vec3 normal, vec3 weights, vec3 x, vec3 y, vec3 z) {
    vec3 sum = weights.x * projected_normal(projection_frame_x(normal), normal, x)
        + weights.y * projected_normal(projection_frame_y(normal), normal, y)
        + weights.z * projected_normal(projection_frame_z(normal), normal, z);
    return unit_or(sum, normal);
}
