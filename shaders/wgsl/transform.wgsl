// Frames under transforms: node matrices, mirrored and unevenly scaled ones included, and skins (darboux::Transform).
// Needs frame.
//
// A tangent goes by the matrix, a normal by its inverse transpose, and a mirror changes the sign w. For one node, all of
// `FrameTransform` can be made once on the CPU; for a skin, each vertex makes its own.

// Where a matrix takes the x, y and z directions: m[0].xyz, m[1].xyz, m[2].xyz in WGSL and GLSL, and in HLSL where vectors are
// transformed by mul(v, m); m._m00_m10_m20, m._m01_m11_m21, m._m02_m12_m22 where by mul(m, v). Translation does not matter.
struct LinearMap {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

// A matrix made ready for frames.
struct FrameTransform {
    // The matrix, scaled.
    map: LinearMap,
    // Its cofactors: the inverse transpose times the determinant.
    cofactors: LinearMap,
    // -1 where it mirrors, which turns the winding of faces as well; else 1.
    orientation: f32,
}

fn linear_map(x: vec3f, y: vec3f, z: vec3f) -> LinearMap {
    var map: LinearMap;
    map.x = x;
    map.y = y;
    map.z = z;
    return map;
}

// The map of no bones yet, for `with_bone`.
fn linear_map_of_no_bones() -> LinearMap {
    let zero: vec3f = vec3f(0.0, 0.0, 0.0);
    return linear_map(zero, zero, zero);
}

// Linear blend skinning, one bone after the other.
fn with_bone(sum: LinearMap, bone: LinearMap, weight: f32) -> LinearMap {
    return linear_map(sum.x + weight * bone.x, sum.y + weight * bone.y, sum.z + weight * bone.z);
}

fn mapped(map: LinearMap, v: vec3f) -> vec3f {
    return v.x * map.x + v.y * map.y + v.z * map.z;
}

// The matrix is first scaled to have 1 as its largest component, so that its products neither overflow nor vanish.
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

// The unit normal of the transformed surface, on the same side of it. One that the transform leaves no direction stays as it is.
fn transformed_normal(transform: FrameTransform, normal: vec3f) -> vec3f {
    return unit_or(transform.orientation * mapped(transform.cofactors, normal), normal);
}

// The unit normal and the unit tangent, perpendicular to it, of the transformed surface.
fn transformed_frame(transform: FrameTransform, frame: VertexFrame) -> VertexFrame {
    var out_frame: VertexFrame;
    out_frame.normal = transformed_normal(transform, frame.normal);
    let tangent: vec3f = unit_in_plane(out_frame.normal, mapped(transform.map, frame.tangent.xyz));
    out_frame.tangent = vec4f(tangent, transform.orientation * frame.tangent.w);
    return out_frame;
}
