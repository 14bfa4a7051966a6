// Generated from shaders/wgsl/anisotropy.wgsl by `cargo xtask gen`.

// The frame of anisotropic highlights (glTF's KHR_materials_anisotropy).
// Needs frame.

// An orthonormal frame whose tangent points along the grooves.
//
// frame: any; its normal may be that of a normal map already. direction: red and green of the anisotropy texture, 2 c - 1;
// (1, 0) without one. rotation: cosine and sine of anisotropyRotation, which turns from the tangent towards the bitangent.
// Highlights are the same on both sides of the grooves: the bitangent is cross(normal, tangent), whatever the frame's sign.
TangentFrame anisotropic_frame(TangentFrame frame, float2 direction, float2 rotation) {
    float along = rotation.x * direction.x - rotation.y * direction.y;
    float across = rotation.y * direction.x + rotation.x * direction.y;
    TangentFrame out_frame;
    out_frame.normal = unit_or(frame.normal, frame.normal);
    out_frame.tangent = unit_in_plane(out_frame.normal, along * frame.tangent + across * frame.bitangent);
    out_frame.bitangent = cross(out_frame.normal, out_frame.tangent);
    return out_frame;
}
