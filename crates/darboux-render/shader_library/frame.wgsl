// Generated from shaders/wgsl/frame.wgsl by `cargo xtask gen`.

// Tangent frames at vertices and pixels. All other files require this one.
//
// A tangent is a unit vector xyz and the sign w of its bitangent, w * cross(normal, xyz), as in MikkTSpace and glTF.

// The frame that a vertex stores: the unit normal and the tangent.
struct VertexFrame {
    normal: vec3f,
    tangent: vec4f,
}

// The columns of the matrix from tangent space to the space of the normal: the directions of the axes x, y and z of tangent space.
struct TangentFrame {
    tangent: vec3f,
    bitangent: vec3f,
    normal: vec3f,
}

// The unit vector along v; `otherwise` if v is zero.
fn unit_or(v: vec3f, otherwise: vec3f) -> vec3f {
    let size: f32 = sqrt(dot(v, v));
    if (size > 0.0) {
        return (1.0 / size) * v;
    }
    return otherwise;
}

// A unit vector that, with `second_perpendicular` and the unit normal, forms a right-handed frame.
// Source: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. Here -0 counts as +0.
fn first_perpendicular(normal: vec3f) -> vec3f {
    var side: f32 = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    let a: f32 = -1.0 / (side + normal.z);
    let b: f32 = normal.x * normal.y * a;
    return vec3f(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
}

// The second vector of the frame. See `first_perpendicular`.
fn second_perpendicular(normal: vec3f) -> vec3f {
    var side: f32 = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    let a: f32 = -1.0 / (side + normal.z);
    let b: f32 = normal.x * normal.y * a;
    return vec3f(b, side + normal.y * normal.y * a, -normal.y);
}

// The unit vector along the part of v perpendicular to the unit normal. If only rounding error is left, any perpendicular vector.
fn unit_in_plane(normal: vec3f, v: vec3f) -> vec3f {
    let rest: vec3f = v - dot(normal, v) * normal;
    let size: f32 = sqrt(dot(rest, rest));
    if (size > 0.000001 * sqrt(dot(v, v))) {
        return (1.0 / size) * rest;
    }
    return first_perpendicular(normal);
}

// The bitangent. Compute it at the vertices or at the pixels, as the baker of the normal map does.
fn bitangent_of(normal: vec3f, tangent: vec4f) -> vec3f {
    return tangent.w * cross(normal, tangent.xyz);
}

// The frame, with the bitangent computed here.
//
// At a pixel: pass the interpolated vectors without normalising them, as MikkTSpace requires. The normal map was baked with exactly this
// frame, and `normal_to_surface` normalises the result.
fn tangent_frame(normal: vec3f, tangent: vec4f) -> TangentFrame {
    var frame: TangentFrame;
    frame.tangent = tangent.xyz;
    frame.bitangent = bitangent_of(normal, tangent);
    frame.normal = normal;
    return frame;
}

// The frame of a pixel whose bitangent was computed at the vertices and interpolated, for maps that were baked in this way.
fn tangent_frame_with_bitangent(normal: vec3f, tangent: vec3f, bitangent: vec3f) -> TangentFrame {
    var frame: TangentFrame;
    frame.tangent = tangent;
    frame.bitangent = bitangent;
    frame.normal = normal;
    return frame;
}

// An orthonormal frame for the unit normal alone, for surfaces without UVs. The direction of its tangent has no meaning.
fn tangent_frame_of_normal(normal: vec3f) -> TangentFrame {
    var frame: TangentFrame;
    frame.tangent = first_perpendicular(normal);
    frame.bitangent = second_perpendicular(normal);
    frame.normal = normal;
    return frame;
}

// The frame with each vector normalised, and their angles unchanged. three.js and many engines do this with interpolated vectors.
fn normalized_frame(frame: TangentFrame) -> TangentFrame {
    var out_frame: TangentFrame;
    out_frame.tangent = unit_or(frame.tangent, frame.tangent);
    out_frame.bitangent = unit_or(frame.bitangent, frame.bitangent);
    out_frame.normal = unit_or(frame.normal, frame.normal);
    return out_frame;
}

// The frame made orthonormal, with the direction of the normal and the sign of the bitangent unchanged. For effects that need right
// angles, such as anisotropic highlights. Do not use it for normal maps.
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

// Transforms a vector from tangent space to the space of the frame.
fn from_tangent_space(frame: TangentFrame, v: vec3f) -> vec3f {
    return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal;
}

// The unit normal of the surface for a normal in tangent space.
fn normal_to_surface(frame: TangentFrame, normal: vec3f) -> vec3f {
    return unit_or(from_tangent_space(frame, normal), frame.normal);
}

// Transforms a direction, such as that to a light or to the eye, to tangent space. The result is not normalised.
//
// It is the inverse of `from_tangent_space` if the frame is orthonormal. In any frame, dot(to_tangent_space(d), n) equals
// dot(d, from_tangent_space(n)): lighting in tangent space gives the same result as lighting in the scene.
fn to_tangent_space(frame: TangentFrame, direction: vec3f) -> vec3f {
    return vec3f(dot(direction, frame.tangent), dot(direction, frame.bitangent), dot(direction, frame.normal));
}
