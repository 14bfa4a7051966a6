// Normal maps projected along the three axes, for surfaces without UVs.
// Needs frame and normal_map.
//
// For each axis: UVs by `projected_uv` in the axis' frame, a texel there, decoded; then `triplanar_normal` of the three.

// The frames of the sides that the normal faces. Seen from outside, u goes right and v up; up is y, on the top -z, on the bottom z.
fn projection_frame_x(normal: vec3f) -> TangentFrame {
    var side: f32 = 1.0;
    if (normal.x < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(vec3f(side, 0.0, 0.0), vec3f(0.0, 0.0, -side), vec3f(0.0, 1.0, 0.0));
}

fn projection_frame_y(normal: vec3f) -> TangentFrame {
    var side: f32 = 1.0;
    if (normal.y < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(vec3f(0.0, side, 0.0), vec3f(1.0, 0.0, 0.0), vec3f(0.0, 0.0, -side));
}

fn projection_frame_z(normal: vec3f) -> TangentFrame {
    var side: f32 = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    return tangent_frame_with_bitangent(vec3f(0.0, 0.0, side), vec3f(side, 0.0, 0.0), vec3f(0.0, 1.0, 0.0));
}

// Where a frame's projection meets its image, one repeat per unit of length. For images whose v goes down, negate v.
fn projected_uv(frame: TangentFrame, position: vec3f) -> vec2f {
    return to_tangent_space(frame, position).xy;
}

// How much each projection counts, 1 in all. sharpness: 1 or more; 4 is usual, higher narrows the seams.
fn triplanar_weights(normal: vec3f, sharpness: f32) -> vec3f {
    let size: vec3f = abs(normal);
    let largest: f32 = max(max(size.x, size.y), size.z);
    let weights: vec3f = pow(size / largest, vec3f(sharpness, sharpness, sharpness));
    return weights / (weights.x + weights.y + weights.z);
}

// A projection's texel laid on the surface, in the space of the normal: the whiteout blend of both in the projection's frame.
fn projected_normal(frame: TangentFrame, normal: vec3f, texel_normal: vec3f) -> vec3f {
    let blended: vec3f = blended_normals_whiteout(to_tangent_space(frame, normal), texel_normal);
    return from_tangent_space(frame, blended);
}

// The unit normal of the surface from the texels of the three projections, decoded.
fn triplanar_normal(normal: vec3f, weights: vec3f, x: vec3f, y: vec3f, z: vec3f) -> vec3f {
    let sum: vec3f = weights.x * projected_normal(projection_frame_x(normal), normal, x)
        + weights.y * projected_normal(projection_frame_y(normal), normal, y)
        + weights.z * projected_normal(projection_frame_z(normal), normal, z);
    return unit_or(sum, normal);
}
