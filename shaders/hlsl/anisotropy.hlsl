// Generated from shaders/wgsl/anisotropy.wgsl by `cargo xtask gen`.

// The tangent frame of anisotropic highlights (KHR_materials_anisotropy of glTF).
// Requires frame.

// An orthonormal frame whose tangent points along the grooves.
//
// frame: any frame; its normal may already include a normal map. direction: 2 c - 1 of the red and green channels of the anisotropy
// texture; (1, 0) without one. rotation: the cosine and sine of anisotropyRotation, which rotates from the tangent to the bitangent.
// Highlights are symmetric about the grooves, so the bitangent is cross(normal, tangent), whatever the sign of the frame.
TangentFrame anisotropic_frame(TangentFrame frame, float2 direction, float2 rotation) {
    float along = rotation.x * direction.x - rotation.y * direction.y;
    float across = rotation.y * direction.x + rotation.x * direction.y;
    TangentFrame out_frame;
    out_frame.normal = unit_or(frame.normal, frame.normal);
    out_frame.tangent = unit_in_plane(out_frame.normal, along * frame.tangent + across * frame.bitangent);
    out_frame.bitangent = cross(out_frame.normal, out_frame.tangent);
    return out_frame;
}
