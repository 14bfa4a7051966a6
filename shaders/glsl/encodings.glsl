// Generated from shaders/wgsl/encodings.wgsl by `cargo xtask gen`.
precision highp float;
precision highp int;

// Decoders of compressed tangents and normals. The encoders have the same names in Rust (darboux::encode, which states the errors).
// Requires frame.
//
// Codes are integers, one component per stored integer. Vertex formats can fetch them (sint8x4, sint16x2, sint16x4, uint32), or
// `bytes_of_word` and `shorts_of_word` extract them from a 32-bit word. A tangent fetched as snorm8x4, snorm16x4 or A2B10G10R10_SNORM is
// already decoded. A tangent of four floats needs no decoder.
//
// The decoders use only + - * / and sqrt, and all their branches depend on integers.

// The signed bytes of a word, lowest byte first.
ivec4 bytes_of_word(uint word) {
    return ivec4(int(word << 24u) >> 24u, int(word << 16u) >> 24u, int(word << 8u) >> 24u, int(word) >> 24u);
}

// The signed 16-bit integers of a word, lower half first.
ivec2 shorts_of_word(uint word) {
    return ivec2(int(word << 16u) >> 16u, int(word) >> 16u);
}

// The tangent of four signed bytes, not normalised.
vec4 tangent_from_snorm8(ivec4 code) {
    return max(vec4(code) / 127.0, vec4(-1.0, -1.0, -1.0, -1.0));
}

// The tangent of four signed 16-bit integers, not normalised.
vec4 tangent_from_snorm16(ivec4 code) {
    return max(vec4(code) / 32767.0, vec4(-1.0, -1.0, -1.0, -1.0));
}

// The tangent of 10 bits each for x (the lowest), y and z, and two bits for w, not normalised.
vec4 tangent_from_snorm10(uint code) {
    ivec3 xyz = ivec3(int(code << 22u) >> 22u, int(code << 12u) >> 22u, int(code << 2u) >> 22u);
    float w = float(int(code) >> 30u);
    return max(vec4(vec3(xyz) / 511.0, w), vec4(-1.0, -1.0, -1.0, -1.0));
}

// The unit vector of a point in the octahedral square [-grid, grid]^2.
// Source: Q. Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010.
vec3 unfold_octahedron(ivec2 code, int grid) {
    ivec3 p = ivec3(code, grid - abs(code.x) - abs(code.y));
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
    vec3 v = vec3(p);
    return (1.0 / sqrt(dot(v, v))) * v;
}

// The unit normal of two signed 16-bit integers.
vec3 normal_from_octahedral(ivec2 code) {
    return unfold_octahedron(code, 32767);
}

// The unit tangent of two signed 16-bit integers. The lowest bit of the second is the sign.
vec4 tangent_from_octahedral(ivec2 code) {
    float w = 1.0;
    if ((code.y & 1) == 1) {
        w = -1.0;
    }
    return vec4(unfold_octahedron(ivec2(code.x, code.y & ~1), 32766), w);
}

// The unit tangent of its direction around the normal: 15 bits for the position on a diamond, the lowest bit for the sign.
// normal: the unit normal that the encoder was given. If the normal is compressed too, this is the decoded normal.
// Source: J. Ong, "Tangent Spaces and Diamond Encoding", 2023.
vec4 tangent_from_diamond(vec3 normal, uint code) {
    float place = float(code >> 1u) / 8192.0;
    float x = 1.0 - place;
    float y = 1.0 - abs(x);
    if (place >= 2.0) {
        x = place - 3.0;
        y = abs(x) - 1.0;
    }
    float w = 1.0;
    if ((code & 1u) == 1u) {
        w = -1.0;
    }
    vec3 tangent = x * first_perpendicular(normal) + y * second_perpendicular(normal);
    return vec4((1.0 / sqrt(dot(tangent, tangent))) * tangent, w);
}

// The frame of a quaternion of four signed 16-bit integers. The scalar is last, and its sign is that of the tangent.
// Source: I. Frey and I. Herzeg, "Spherical Skinning with Dual-Quaternions and QTangents", SIGGRAPH Talks 2011.
VertexFrame frame_from_quaternion(ivec4 code) {
    vec4 q = vec4(code);
    float twice = 2.0 / dot(q, q);
    float w = 1.0;
    if (code.w < 0) {
        w = -1.0;
    }
    VertexFrame frame;
    frame.normal = vec3(
        twice * (q.x * q.z + q.w * q.y),
        twice * (q.y * q.z - q.w * q.x),
        1.0 - twice * (q.x * q.x + q.y * q.y)
    );
    frame.tangent = vec4(
        1.0 - twice * (q.y * q.y + q.z * q.z),
        twice * (q.x * q.y + q.w * q.z),
        twice * (q.x * q.z - q.w * q.y),
        w
    );
    return frame;
}
