// Generated from shaders/wgsl/displacement.wgsl by `cargo xtask gen`.

// Displacement of vertices along the frame.
// Needs frame.

// A position moved by a vector of tangent space: (0, 0, h) for a height map.
float3 displaced_position(float3 position, TangentFrame frame, float3 displacement) {
    return position + from_tangent_space(frame, displacement);
}

// The frame of the displaced surface: its vectors tilted by the slopes of the heights; not made unit, but the normal is.
//
// frame: orthonormal, of either sign. slopes: height gained per unit of length along the tangent and along the bitangent. Exact on flat
// surfaces; on bent ones it leaves out that heights stretch the surface, as is usual.
// Source: J. Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978.
TangentFrame displaced_frame(TangentFrame frame, float2 slopes) {
    TangentFrame out_frame;
    out_frame.tangent = frame.tangent + slopes.x * frame.normal;
    out_frame.bitangent = frame.bitangent + slopes.y * frame.normal;
    float3 normal = frame.normal - slopes.x * frame.tangent - slopes.y * frame.bitangent;
    out_frame.normal = unit_or(normal, frame.normal);
    return out_frame;
}
