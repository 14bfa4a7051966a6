// Generated from shaders/wgsl/displacement.wgsl by `cargo xtask gen`.
precision highp float;
precision highp int;

// Displaces vertices in their tangent frame.
// Requires frame.

// The position displaced by a vector in tangent space: (0, 0, h) for a height map.
vec3 displaced_position(vec3 position, TangentFrame frame, vec3 displacement) {
    return position + from_tangent_space(frame, displacement);
}

// The frame of the displaced surface. The normal is a unit vector, tangent and bitangent are not normalised.
//
// frame: orthonormal, with either sign. slopes: the increase of height per unit of length along the tangent and along the bitangent.
// Exact on flat surfaces; on curved surfaces it ignores, as usual, that displacement stretches the surface.
// Source: J. Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978.
TangentFrame displaced_frame(TangentFrame frame, vec2 slopes) {
    TangentFrame out_frame;
    out_frame.tangent = frame.tangent + slopes.x * frame.normal;
    out_frame.bitangent = frame.bitangent + slopes.y * frame.normal;
    vec3 normal = frame.normal - slopes.x * frame.tangent - slopes.y * frame.bitangent;
    out_frame.normal = unit_or(normal, frame.normal);
    return out_frame;
}
