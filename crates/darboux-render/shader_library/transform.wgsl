// Generated from shaders/wgsl/transform.wgsl by `cargo xtask gen`.

// Transforms frames by the matrices of nodes, which may mirror and scale non-uniformly, and by skins (darboux::Transform).
// Requires frame.
//
// A tangent is transformed by the matrix, a normal by its inverse transpose, and a matrix that mirrors negates the sign w. For a node, the
// CPU can compute `FrameTransform` once; for a skin, each vertex computes its own.

// The images of the x, y and z axes under a matrix: m[0].xyz, m[1].xyz, m[2].xyz in WGSL and GLSL, and in HLSL if vectors are transformed
// by mul(v, m); m._m00_m10_m20, m._m01_m11_m21, m._m02_m12_m22 in HLSL with mul(m, v). Translation does not matter.
struct LinearMap {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

// A matrix, prepared to transform frames.
struct FrameTransform {
    // The scaled matrix.
    map: LinearMap,
    // Its cofactor matrix: the inverse transpose times the determinant.
    cofactors: LinearMap,
    // -1 if the matrix mirrors, which also reverses the winding of faces; otherwise 1.
    orientation: f32,
}

fn linear_map(x: vec3f, y: vec3f, z: vec3f) -> LinearMap {
    var map: LinearMap;
    map.x = x;
    map.y = y;
    map.z = z;
    return map;
}

// A zero map, to which `with_bone` adds bones.
fn linear_map_of_no_bones() -> LinearMap {
    let zero: vec3f = vec3f(0.0, 0.0, 0.0);
    return linear_map(zero, zero, zero);
}

// Linear blend skinning: adds one bone.
fn with_bone(sum: LinearMap, bone: LinearMap, weight: f32) -> LinearMap {
    return linear_map(sum.x + weight * bone.x, sum.y + weight * bone.y, sum.z + weight * bone.z);
}

fn mapped(map: LinearMap, v: vec3f) -> vec3f {
    return v.x * map.x + v.y * map.y + v.z * map.z;
}

// The matrix is first scaled so that its largest element is 1. So its products neither overflow nor underflow.
fn frame_transform(map: LinearMap) -> FrameTransform {
    let larger: vec3f = max(max(abs(map.x), abs(map.y)), abs(map.z));
    let largest: f32 = max(max(larger.x, larger.y), larger.z);
    var transform: FrameTransform;
    transform.map = map;
    if (largest > 0.0) {
        transform.map = linear_map(map.x / largest, map.y / largest, map.z / largest);
    }
    let x: vec3f = transform.map.x;
    let y: vec3f = transform.map.y;
    let z: vec3f = transform.map.z;
    transform.cofactors = linear_map(cross(y, z), cross(z, x), cross(x, y));
    transform.orientation = 1.0;
    if (dot(x, cross(y, z)) < 0.0) {
        transform.orientation = -1.0;
    }
    return transform;
}

// The unit normal of the transformed surface, on the same side. If the transform makes it zero, the normal is returned unchanged.
fn transformed_normal(transform: FrameTransform, normal: vec3f) -> vec3f {
    return unit_or(transform.orientation * mapped(transform.cofactors, normal), normal);
}

// The unit normal of the transformed surface, and the unit tangent perpendicular to it.
fn transformed_frame(transform: FrameTransform, frame: VertexFrame) -> VertexFrame {
    var out_frame: VertexFrame;
    out_frame.normal = transformed_normal(transform, frame.normal);
    let tangent: vec3f = unit_in_plane(out_frame.normal, mapped(transform.map, frame.tangent.xyz));
    out_frame.tangent = vec4f(tangent, transform.orientation * frame.tangent.w);
    return out_frame;
}
