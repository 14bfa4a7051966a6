// Displacement of vertices along the frame.
// Needs frame.

// A position moved by a vector of tangent space: (0, 0, h) for a height map.
fn displaced_position(position: vec3f, frame: TangentFrame, displacement: vec3f) -> vec3f {
    return position + from_tangent_space(frame, displacement);
}

// The frame of the displaced surface: its vectors tilted by the slopes of the heights; not made unit, but the normal is.
//
// frame: orthonormal, of either sign. slopes: height gained per unit of length along the tangent and along the bitangent. Exact on flat
// surfaces; on bent ones it leaves out that heights stretch the surface, as is usual.
// Source: J. Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978.
fn displaced_frame(frame: TangentFrame, slopes: vec2f) -> TangentFrame {
    var out_frame: TangentFrame;
    out_frame.tangent = frame.tangent + slopes.x * frame.normal;
    out_frame.bitangent = frame.bitangent + slopes.y * frame.normal;
    let normal: vec3f = frame.normal - slopes.x * frame.tangent - slopes.y * frame.bitangent;
    out_frame.normal = unit_or(normal, frame.normal);
    return out_frame;
}
