// Generated from shaders/wgsl/transform.wgsl by `cargo xtask gen`.
precision highp float;
precision highp int;

// Transforms frames by the matrices of nodes, which may mirror and scale non-uniformly, and by skins (darboux::Transform).
// Requires frame.
//
// A tangent is transformed by the matrix, a normal by its inverse transpose, and a matrix that mirrors negates the sign w. For a node, the
// CPU can compute `FrameTransform` once; for a skin, each vertex computes its own.

// The images of the x, y and z axes under a matrix: m[0].xyz, m[1].xyz, m[2].xyz in WGSL and GLSL, and in HLSL if vectors are transformed
// by mul(v, m); m._m00_m10_m20, m._m01_m11_m21, m._m02_m12_m22 in HLSL with mul(m, v). Translation does not matter.
struct LinearMap {
    vec3 x;
    vec3 y;
    vec3 z;
};

// A matrix, prepared to transform frames.
struct FrameTransform {
    // The scaled matrix.
    LinearMap map;
    // Its cofactor matrix: the inverse transpose times the determinant.
    LinearMap cofactors;
    // -1 if the matrix mirrors, which also reverses the winding of faces; otherwise 1.
    float orientation;
};

LinearMap linear_map(vec3 x, vec3 y, vec3 z) {
    LinearMap map;
    map.x = x;
    map.y = y;
    map.z = z;
    return map;
}

// A zero map, to which `with_bone` adds bones.
LinearMap linear_map_of_no_bones() {
    vec3 zero = vec3(0.0, 0.0, 0.0);
    return linear_map(zero, zero, zero);
}

// Linear blend skinning: adds one bone.
LinearMap with_bone(LinearMap sum, LinearMap bone, float weight) {
    return linear_map(sum.x + weight * bone.x, sum.y + weight * bone.y, sum.z + weight * bone.z);
}

vec3 mapped(LinearMap map, vec3 v) {
    return v.x * map.x + v.y * map.y + v.z * map.z;
}

// The matrix is first scaled so that its largest element is 1. So its products neither overflow nor underflow.
FrameTransform frame_transform(LinearMap map) {
    vec3 larger = max(max(abs(map.x), abs(map.y)), abs(map.z));
    float largest = max(max(larger.x, larger.y), larger.z);
    FrameTransform transform;
    transform.map = map;
    if (largest > 0.0) {
        transform.map = linear_map(map.x / largest, map.y / largest, map.z / largest);
    }
    vec3 x = transform.map.x;
    vec3 y = transform.map.y;
    vec3 z = transform.map.z;
    transform.cofactors = linear_map(cross(y, z), cross(z, x), cross(x, y));
    transform.orientation = 1.0;
    if (dot(x, cross(y, z)) < 0.0) {
        transform.orientation = -1.0;
    }
    return transform;
}

// The unit normal of the transformed surface, on the same side. If the transform makes it zero, the normal is returned unchanged.
vec3 transformed_normal(FrameTransform transform, vec3 normal) {
    return unit_or(transform.orientation * mapped(transform.cofactors, normal), normal);
}

// The unit normal of the transformed surface, and the unit tangent perpendicular to it.
VertexFrame transformed_frame(FrameTransform transform, VertexFrame frame) {
    VertexFrame out_frame;
    out_frame.normal = transformed_normal(transform, frame.normal);
    vec3 tangent = unit_in_plane(out_frame.normal, mapped(transform.map, frame.tangent.xyz));
    out_frame.tangent = vec4(tangent, transform.orientation * frame.tangent.w);
    return out_frame;
}
