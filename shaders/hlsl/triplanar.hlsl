// Generated from shaders/wgsl/triplanar.wgsl by `cargo xtask gen`.

// Normal maps projected along the three axes, for surfaces without UVs.
// Needs frame and normal_map.
//
// For each axis: UVs by `projected_uv` in the axis' frame, a texel there, decoded; then `triplanar_normal` of the three.

// The frames of the sides that the normal faces. Seen from outside, u goes right and v up; up is y, on the top -z, on the bottom z.
TangentFrame projection_frame_x(float3 normal) {
    float side = 1.0;
    if (normal.x < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(float3(side, 0.0, 0.0), float3(0.0, 0.0, -side), float3(0.0, 1.0, 0.0));
}

TangentFrame projection_frame_y(float3 normal) {
    float side = 1.0;
    if (normal.y < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(float3(0.0, side, 0.0), float3(1.0, 0.0, 0.0), float3(0.0, 0.0, -side));
}

TangentFrame projection_frame_z(float3 normal) {
    float side = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(float3(0.0, 0.0, side), float3(side, 0.0, 0.0), float3(0.0, 1.0, 0.0));
}

// Where a frame's projection meets its image, one repeat per unit of length. For images whose v goes down, negate v.
float2 projected_uv(TangentFrame frame, float3 position) {
    return to_tangent_space(frame, position).xy;
}

// How much each projection counts, 1 in all. sharpness: 1 or more; 4 is usual, higher narrows the seams.
float3 triplanar_weights(float3 normal, float sharpness) {
    float3 size = abs(normal);
    float largest = max(max(size.x, size.y), size.z);
    float3 weights = pow(size / largest, float3(sharpness, sharpness, sharpness));
    return weights / (weights.x + weights.y + weights.z);
}

// A projection's texel laid on the surface, in the space of the normal: the whiteout blend of both in the projection's frame.
float3 projected_normal(TangentFrame frame, float3 normal, float3 texel_normal) {
    float3 blended = blended_normals_whiteout(to_tangent_space(frame, normal), texel_normal);
    return from_tangent_space(frame, blended);
}

// The unit normal of the surface from the texels of the three projections, decoded.
float3 triplanar_normal(float3 normal, float3 weights, float3 x, float3 y, float3 z) {
    float3 sum = weights.x * projected_normal(projection_frame_x(normal), normal, x)
        + weights.y * projected_normal(projection_frame_y(normal), normal, y)
        + weights.z * projected_normal(projection_frame_z(normal), normal, z);
    return unit_or(sum, normal);
}
