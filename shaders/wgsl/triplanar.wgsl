// Triplanar mapping: projects a normal map along the three axes, for surfaces without UVs.
// Requires frame and normal_map.
//
// For each axis, compute the UVs with `projected_uv` in the frame of the axis, sample the map there and decode the texel. Then pass the three
// normals to `triplanar_normal`.

// The frames of the three sides that the normal faces. Seen from outside, u points right and v up. Up is y; on the top -z, on the bottom z.
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

// The UV of a position in the projection of a frame, with one repetition per unit of length. Negate v if it points down in the image.
fn projected_uv(frame: TangentFrame, position: vec3f) -> vec2f {
    return to_tangent_space(frame, position).xy;
}

// The weights of the three projections, whose sum is 1. sharpness: at least 1; 4 is common, higher values narrow the transitions.
fn triplanar_weights(normal: vec3f, sharpness: f32) -> vec3f {
    let size: vec3f = abs(normal);
    let largest: f32 = max(max(size.x, size.y), size.z);
    let weights: vec3f = pow(size / largest, vec3f(sharpness, sharpness, sharpness));
    return weights / (weights.x + weights.y + weights.z);
}

// The normal of one projection in the space of the surface: the whiteout blend of texel and surface normal in the projection's frame.
fn projected_normal(frame: TangentFrame, normal: vec3f, texel_normal: vec3f) -> vec3f {
    let blended: vec3f = blended_normals_whiteout(to_tangent_space(frame, normal), texel_normal);
    return from_tangent_space(frame, blended);
}

// The unit normal of the surface, from the decoded texels of the three projections.
fn triplanar_normal(normal: vec3f, weights: vec3f, x: vec3f, y: vec3f, z: vec3f) -> vec3f {
    let sum: vec3f = weights.x * projected_normal(projection_frame_x(normal), normal, x)
        + weights.y * projected_normal(projection_frame_y(normal), normal, y)
        + weights.z * projected_normal(projection_frame_z(normal), normal, z);
    return unit_or(sum, normal);
}
