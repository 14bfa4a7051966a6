// Generated from shaders/wgsl/frame.wgsl by `cargo xtask gen`.

// Tangent frames at vertices and pixels. All other files require this one.
//
// A tangent is a unit vector xyz and the sign w of its bitangent, w * cross(normal, xyz), as in MikkTSpace and glTF.

// The frame that a vertex stores: the unit normal and the tangent.
struct VertexFrame {
    float3 normal;
    float4 tangent;
};

// The columns of the matrix from tangent space to the space of the normal: the directions of the axes x, y and z of tangent space.
struct TangentFrame {
    float3 tangent;
    float3 bitangent;
    float3 normal;
};

// The unit vector along v; `otherwise` if v is zero.
float3 unit_or(float3 v, float3 otherwise) {
    float size = sqrt(dot(v, v));
    if (size > 0.0) {
        return (1.0 / size) * v;
    }
    return otherwise;
}

// A unit vector that, with `second_perpendicular` and the unit normal, forms a right-handed frame.
// Source: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. Here -0 counts as +0.
float3 first_perpendicular(float3 normal) {
    float side = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    float a = -1.0 / (side + normal.z);
    float b = normal.x * normal.y * a;
    return float3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
}

// The second vector of the frame. See `first_perpendicular`.
float3 second_perpendicular(float3 normal) {
    float side = 1.0;
    if (normal.z < 0.0) {
        side = -1.0;
    }
    float a = -1.0 / (side + normal.z);
    float b = normal.x * normal.y * a;
    return float3(b, side + normal.y * normal.y * a, -normal.y);
}

// The unit vector along the part of v perpendicular to the unit normal. If only rounding error is left, any perpendicular vector.
float3 unit_in_plane(float3 normal, float3 v) {
    float3 rest = v - dot(normal, v) * normal;
    float size = sqrt(dot(rest, rest));
    if (size > 0.000001 * sqrt(dot(v, v))) {
        return (1.0 / size) * rest;
    }
    return first_perpendicular(normal);
}

// The bitangent. Compute it at the vertices or at the pixels, as the baker of the normal map does.
float3 bitangent_of(float3 normal, float4 tangent) {
    return tangent.w * cross(normal, tangent.xyz);
}

// The frame, with the bitangent computed here.
//
// At a pixel: pass the interpolated vectors without normalising them, as MikkTSpace requires. The normal map was baked with exactly this
// frame, and `normal_to_surface` normalises the result.
TangentFrame tangent_frame(float3 normal, float4 tangent) {
    TangentFrame frame;
    frame.tangent = tangent.xyz;
    frame.bitangent = bitangent_of(normal, tangent);
    frame.normal = normal;
    return frame;
}

// The frame of a pixel whose bitangent was computed at the vertices and interpolated, for maps that were baked in this way.
TangentFrame tangent_frame_with_bitangent(float3 normal, float3 tangent, float3 bitangent) {
    TangentFrame frame;
    frame.tangent = tangent;
    frame.bitangent = bitangent;
    frame.normal = normal;
    return frame;
}

// An orthonormal frame for the unit normal alone, for surfaces without UVs. The direction of its tangent has no meaning.
TangentFrame tangent_frame_of_normal(float3 normal) {
    TangentFrame frame;
    frame.tangent = first_perpendicular(normal);
    frame.bitangent = second_perpendicular(normal);
    frame.normal = normal;
    return frame;
}

// The frame with each vector normalised, and their angles unchanged. three.js and many engines do this with interpolated vectors.
TangentFrame normalized_frame(TangentFrame frame) {
    TangentFrame out_frame;
    out_frame.tangent = unit_or(frame.tangent, frame.tangent);
    out_frame.bitangent = unit_or(frame.bitangent, frame.bitangent);
    out_frame.normal = unit_or(frame.normal, frame.normal);
    return out_frame;
}

// The frame made orthonormal, with the direction of the normal and the sign of the bitangent unchanged. For effects that need right
// angles, such as anisotropic highlights. Do not use it for normal maps.
TangentFrame orthonormal_frame(TangentFrame frame) {
    TangentFrame out_frame;
    out_frame.normal = unit_or(frame.normal, frame.normal);
    out_frame.tangent = unit_in_plane(out_frame.normal, frame.tangent);
    out_frame.bitangent = cross(out_frame.normal, out_frame.tangent);
    if (dot(out_frame.bitangent, frame.bitangent) < 0.0) {
        out_frame.bitangent = -out_frame.bitangent;
    }
    return out_frame;
}

// Transforms a vector from tangent space to the space of the frame.
float3 from_tangent_space(TangentFrame frame, float3 v) {
    return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal;
}

// The unit normal of the surface for a normal in tangent space.
float3 normal_to_surface(TangentFrame frame, float3 normal) {
    return unit_or(from_tangent_space(frame, normal), frame.normal);
}

// Transforms a direction, such as that to a light or to the eye, to tangent space. The result is not normalised.
//
// It is the inverse of `from_tangent_space` if the frame is orthonormal. In any frame, dot(to_tangent_space(d), n) equals
// dot(d, from_tangent_space(n)): lighting in tangent space gives the same result as lighting in the scene.
float3 to_tangent_space(TangentFrame frame, float3 direction) {
    return float3(dot(direction, frame.tangent), dot(direction, frame.bitangent), dot(direction, frame.normal));
}
