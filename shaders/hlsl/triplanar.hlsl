// Generated from shaders/wgsl/triplanar.wgsl by `cargo xtask gen`.

// Triplanar mapping: projects a normal map along the three axes, for surfaces without UVs.
// Requires frame and normal_map.
//
// For each axis, compute the UVs with `projected_uv` in the frame of the axis, sample the map there and decode the texel. Then pass the three
// normals to `triplanar_normal`.

// The frames of the three sides that the normal faces. Seen from outside, u points right and v up. Up is y; on the top -z, on the bottom z.
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

// The UV of a position in the projection of a frame, with one repetition per unit of length. Negate v if it points down in the image.
float2 projected_uv(TangentFrame frame, float3 position) {
    return to_tangent_space(frame, position).xy;
}

// The weights of the three projections, whose sum is 1. sharpness: at least 1; 4 is common, higher values narrow the transitions.
float3 triplanar_weights(float3 normal, float sharpness) {
    float3 size = abs(normal);
    float largest = max(max(size.x, size.y), size.z);
    float3 weights = pow(size / largest, float3(sharpness, sharpness, sharpness));
    return weights / (weights.x + weights.y + weights.z);
}

// The normal of one projection in the space of the surface: the whiteout blend of texel and surface normal in the projection's frame.
float3 projected_normal(TangentFrame frame, float3 normal, float3 texel_normal) {
    float3 blended = blended_normals_whiteout(to_tangent_space(frame, normal), texel_normal);
    return from_tangent_space(frame, blended);
}

// The unit normal of the surface, from the decoded texels of the three projections.
float3 triplanar_normal(float3 normal, float3 weights, float3 x, float3 y, float3 z) {
    float3 sum = weights.x * projected_normal(projection_frame_x(normal), normal, x)
        + weights.y * projected_normal(projection_frame_y(normal), normal, y)
        + weights.z * projected_normal(projection_frame_z(normal), normal, z);
    return unit_or(sum, normal);
}
