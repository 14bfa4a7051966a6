// Frames at vertices and pixels. All other files need this one.
//
// A tangent is a unit vector xyz and the sign w of its bitangent, w * cross(normal, xyz), as in MikkTSpace and glTF.

// What a vertex holds: the unit normal, and the tangent.
struct VertexFrame {
    normal: vec3f,
    tangent: vec4f,
}

// Where tangent space's x, y and z point: the columns of the matrix from tangent space to the space of the normal.
struct TangentFrame {
    tangent: vec3f,
    bitangent: vec3f,
    normal: vec3f,
}

// The vector along v of length 1; `otherwise` where v is zero.
fn unit_or(v: vec3f, otherwise: vec3f) -> vec3f {
    let size: f32 = sqrt(dot(v, v));
    if (size > 0.0) {
        return (1.0 / size) * v;
    }
    return otherwise;
}

// The unit vector that with `second_perpendicular` and the unit normal makes a right-handed frame.
// Source: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017; -0 counts as +0.
fn first_perpendicular(normal: vec3f) -> vec3f {
    var side: f32 = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    let a: f32 = -1.0 / (side + normal.z);
    let b: f32 = normal.x * normal.y * a;
    return vec3f(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
}

// The other vector of `first_perpendicular`.
fn second_perpendicular(normal: vec3f) -> vec3f {
    var side: f32 = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    let a: f32 = -1.0 / (side + normal.z);
    let b: f32 = normal.x * normal.y * a;
    return vec3f(b, side + normal.y * normal.y * a, -normal.y);
}

// The unit direction of v in the plane of the unit normal; a perpendicular of the normal where only rounding error is left of v.
fn unit_in_plane(normal: vec3f, v: vec3f) -> vec3f {
    let rest: vec3f = v - dot(normal, v) * normal;
    let size: f32 = sqrt(dot(rest, rest));
    if (size > 0.000001 * sqrt(dot(v, v))) {
        return (1.0 / size) * rest;
    }
    return first_perpendicular(normal);
}

// The bitangent, where it is not stored: at the vertex or at the pixel, whichever the baker of the map did.
fn bitangent_of(normal: vec3f, tangent: vec4f) -> vec3f {
    return tangent.w * cross(normal, tangent.xyz);
}

// The frame, its bitangent rebuilt here.
//
// At a pixel: give the vectors as interpolation leaves them, shorter than 1. MikkTSpace wants them so; the normal in the map was
// baked against that very frame, and `normal_to_surface` makes the result unit.
fn tangent_frame(normal: vec3f, tangent: vec4f) -> TangentFrame {
    var frame: TangentFrame;
    frame.tangent = tangent.xyz;
    frame.bitangent = bitangent_of(normal, tangent);
    frame.normal = normal;
    return frame;
}

// The frame of a pixel whose bitangent was rebuilt at the vertices and interpolated, for maps that were baked so.
fn tangent_frame_with_bitangent(normal: vec3f, tangent: vec3f, bitangent: vec3f) -> TangentFrame {
    var frame: TangentFrame;
    frame.tangent = tangent;
    frame.bitangent = bitangent;
    frame.normal = normal;
    return frame;
}

// An orthonormal frame around the unit normal alone, for surfaces without UVs: which way its tangent points means nothing.
fn tangent_frame_of_normal(normal: vec3f) -> TangentFrame {
    var frame: TangentFrame;
    frame.tangent = first_perpendicular(normal);
    frame.bitangent = second_perpendicular(normal);
    frame.normal = normal;
    return frame;
}

// The frame with each vector made unit, angles between them kept: what three.js and many engines do with interpolated vectors.
fn normalized_frame(frame: TangentFrame) -> TangentFrame {
    var out_frame: TangentFrame;
    out_frame.tangent = unit_or(frame.tangent, frame.tangent);
    out_frame.bitangent = unit_or(frame.bitangent, frame.bitangent);
    out_frame.normal = unit_or(frame.normal, frame.normal);
    return out_frame;
}

// The frame made orthonormal around its normal, the bitangent on the side where it was: for what needs true angles, such as
// anisotropic highlights. Not for normal maps.
fn orthonormal_frame(frame: TangentFrame) -> TangentFrame {
    var out_frame: TangentFrame;
    out_frame.normal = unit_or(frame.normal, frame.normal);
    out_frame.tangent = unit_in_plane(out_frame.normal, frame.tangent);
    out_frame.bitangent = cross(out_frame.normal, out_frame.tangent);
    if (dot(out_frame.bitangent, frame.bitangent) < 0.0) {
        out_frame.bitangent = -out_frame.bitangent;
    }
    return out_frame;
}

// A vector of tangent space in the space of the frame.
fn from_tangent_space(frame: TangentFrame, v: vec3f) -> vec3f {
    return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal;
}

// The unit normal of the surface, from a normal of tangent space.
fn normal_to_surface(frame: TangentFrame, normal: vec3f) -> vec3f {
    return unit_or(from_tangent_space(frame, normal), frame.normal);
}

// A direction, such as that to a light or to the eye, in tangent space; not made unit.
//
// The inverse of `from_tangent_space` if the frame is orthonormal. In any frame, its dot product with a normal of tangent space is that
// of the direction with `from_tangent_space` of the normal: light in tangent space, or normals in the scene's, give the same.
fn to_tangent_space(frame: TangentFrame, direction: vec3f) -> vec3f {
    return vec3f(dot(direction, frame.tangent), dot(direction, frame.bitangent), dot(direction, frame.normal));
}
