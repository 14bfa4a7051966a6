// Decoders of compressed tangents and normals. The encoders have the same names in Rust (darboux::encode, which states the errors).
// Requires frame.
//
// Codes are integers, one component per stored integer. Vertex formats can fetch them (sint8x4, sint16x2, sint16x4, uint32), or
// `bytes_of_word` and `shorts_of_word` extract them from a 32-bit word. A tangent fetched as snorm8x4, snorm16x4 or A2B10G10R10_SNORM is
// already decoded. A tangent of four floats needs no decoder.
//
// The decoders use only + - * / and sqrt, and all their branches depend on integers.

// The signed bytes of a word, lowest byte first.
fn bytes_of_word(word: u32) -> vec4i {
    return vec4i(i32(word << 24u) >> 24u, i32(word << 16u) >> 24u, i32(word << 8u) >> 24u, i32(word) >> 24u);
}

// The signed 16-bit integers of a word, lower half first.
fn shorts_of_word(word: u32) -> vec2i {
    return vec2i(i32(word << 16u) >> 16u, i32(word) >> 16u);
}

// The tangent of four signed bytes, not normalised.
fn tangent_from_snorm8(code: vec4i) -> vec4f {
    return max(vec4f(code) / 127.0, vec4f(-1.0, -1.0, -1.0, -1.0));
}

// The tangent of four signed 16-bit integers, not normalised.
fn tangent_from_snorm16(code: vec4i) -> vec4f {
    return max(vec4f(code) / 32767.0, vec4f(-1.0, -1.0, -1.0, -1.0));
}

// The tangent of 10 bits each for x (the lowest), y and z, and two bits for w, not normalised.
fn tangent_from_snorm10(code: u32) -> vec4f {
    let xyz: vec3i = vec3i(i32(code << 22u) >> 22u, i32(code << 12u) >> 22u, i32(code << 2u) >> 22u);
    let w: f32 = f32(i32(code) >> 30u);
    return max(vec4f(vec3f(xyz) / 511.0, w), vec4f(-1.0, -1.0, -1.0, -1.0));
}

// The unit vector of a point in the octahedral square [-grid, grid]^2.
// Source: Q. Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010.
fn unfold_octahedron(code: vec2i, grid: i32) -> vec3f {
    var p: vec3i = vec3i(code, grid - abs(code.x) - abs(code.y));
    if (p.z < 0) {
        p.x = grid - abs(code.y);
        p.y = grid - abs(code.x);
        if (code.x < 0) {
            p.x = -p.x;
        }
        if (code.y < 0) {
            p.y = -p.y;
        }
    }
    let v: vec3f = vec3f(p);
    return (1.0 / sqrt(dot(v, v))) * v;
}

// The unit normal of two signed 16-bit integers.
fn normal_from_octahedral(code: vec2i) -> vec3f {
    return unfold_octahedron(code, 32767);
}

// The unit tangent of two signed 16-bit integers. The lowest bit of the second is the sign.
fn tangent_from_octahedral(code: vec2i) -> vec4f {
    var w: f32 = 1.0;
    if ((code.y & 1) == 1) {
        w = -1.0;
    }
    return vec4f(unfold_octahedron(vec2i(code.x, code.y & ~1), 32766), w);
}

// The unit tangent of its direction around the normal: 15 bits for the position on a diamond, the lowest bit for the sign.
// normal: the unit normal that the encoder was given. If the normal is compressed too, this is the decoded normal.
// Source: J. Ong, "Tangent Spaces and Diamond Encoding", 2023.
fn tangent_from_diamond(normal: vec3f, code: u32) -> vec4f {
    let place: f32 = f32(code >> 1u) / 8192.0;
    var x: f32 = 1.0 - place;
    var y: f32 = 1.0 - abs(x);
    if (place >= 2.0) {
        x = place - 3.0;
        y = abs(x) - 1.0;
    }
    var w: f32 = 1.0;
    if ((code & 1u) == 1u) {
        w = -1.0;
    }
    let tangent: vec3f = x * first_perpendicular(normal) + y * second_perpendicular(normal);
    return vec4f((1.0 / sqrt(dot(tangent, tangent))) * tangent, w);
}

// The frame of a quaternion of four signed 16-bit integers. The scalar is last, and its sign is that of the tangent.
// Source: I. Frey and I. Herzeg, "Spherical Skinning with Dual-Quaternions and QTangents", SIGGRAPH Talks 2011.
fn frame_from_quaternion(code: vec4i) -> VertexFrame {
    let q: vec4f = vec4f(code);
    let twice: f32 = 2.0 / dot(q, q);
    var w: f32 = 1.0;
    if (code.w < 0) {
        w = -1.0;
    }
    var frame: VertexFrame;
    frame.normal = vec3f(
        twice * (q.x * q.z + q.w * q.y),
        twice * (q.y * q.z - q.w * q.x),
        1.0 - twice * (q.x * q.x + q.y * q.y),
    );
    frame.tangent = vec4f(
        1.0 - twice * (q.y * q.y + q.z * q.z),
        twice * (q.x * q.y + q.w * q.z),
        twice * (q.x * q.z - q.w * q.y),
        w,
    );
    return frame;
}
