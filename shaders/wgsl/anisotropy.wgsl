// The frame of anisotropic highlights (glTF's KHR_materials_anisotropy).
// Needs frame.

// An orthonormal frame whose tangent points along the grooves.
//
// frame: any; its normal may be that of a normal map already. direction: red and green of the anisotropy texture, 2 c - 1;
// (1, 0) without one. rotation: cosine and sine of anisotropyRotation, which turns from the tangent towards the bitangent.
// Highlights are the same on both sides of the grooves: the bitangent is cross(normal, tangent), whatever the frame's sign.
fn anisotropic_frame(frame: TangentFrame, direction: vec2f, rotation: vec2f) -> TangentFrame {
    let along: f32 = rotation.x * direction.x - rotation.y * direction.y;
    let across: f32 = rotation.y * direction.x + rotation.x * direction.y;
    var out_frame: TangentFrame;
    out_frame.normal = unit_or(frame.normal, frame.normal);
    out_frame.tangent = unit_in_plane(out_frame.normal, along * frame.tangent + across * frame.bitangent);
    out_frame.bitangent = cross(out_frame.normal, out_frame.tangent);
    return out_frame;
}
