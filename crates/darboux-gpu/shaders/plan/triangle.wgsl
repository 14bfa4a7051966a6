// Loads the triangles of a plan: the stored data, which does not depend on positions, and the current positions and normals.

@group(0) @binding(1) var<storage, read> positions: array<u32>;
@group(0) @binding(2) var<storage, read> normals: array<u32>;
// Five words per triangle: the vertices of its corners, with two flags each, and the differences of v along the edges from its first corner.
@group(0) @binding(3) var<storage, read> triangles: array<u32>;
// The first vertex that equalled each vertex in the planned mesh.
@group(0) @binding(4) var<storage, read> representatives: array<u32>;

const VERTEX: u32 = 0x3fffffffu;
// Flag of the first corner: the UV map mirrors the triangle.
const MIRRORS: u32 = 0x80000000u;
// Flags of the second corner: the triangle has no term; it had two equal positions.
const ADDS_NOTHING: u32 = 0x80000000u;
const IS_DEGENERATE: u32 = 0x40000000u;
// Flag of the third corner: a vertex of the triangle is not its own representative.
const HAS_COPIES: u32 = 0x80000000u;

struct Triangle {
    vertices: vec3u,
    representatives: vec3u,
    flags: vec3u,
    dv: vec2<Real>,
}

fn load_triangle(t: u32) -> Triangle {
    let word = 5u * t;
    let corners = vec3u(triangles[word], triangles[word + 1u], triangles[word + 2u]);
    let own = corners & vec3u(VERTEX);
    var copied_from = own;
    if (corners.z & HAS_COPIES) != 0u {
        copied_from = vec3u(representatives[own.x], representatives[own.y], representatives[own.z]);
    }
    let dv = vec2<Real>(real(triangles[word + 3u]), real(triangles[word + 4u]));
    check_range(dv.x);
    check_range(dv.y);
    return Triangle(own, copied_from, corners & ~vec3u(VERTEX), dv);
}

fn load_position(vertex: u32) -> V3 {
    let word = vertex * plan.position_stride + plan.position;
    let found = V3(real(positions[word]), real(positions[word + 1u]), real(positions[word + 2u]));
    check_range3(found);
    return found;
}

fn load_normal(vertex: u32) -> V3 {
    let word = vertex * plan.normal_stride + plan.normal;
    let found = V3(real(normals[word]), real(normals[word + 1u]), real(normals[word + 2u]));
    check_normal_range3(found);
    return found;
}

fn are_equal_words(a: u32, b: u32) -> bool {
    return (a == b || ((a | b) & ~SIGN) == 0u) && !is_nan(a);
}

fn are_equal(a: V3, b: V3) -> bool {
    let x = are_equal_words(bits_of(a.x), bits_of(b.x));
    let y = are_equal_words(bits_of(a.y), bits_of(b.y));
    return x && y && are_equal_words(bits_of(a.z), bits_of(b.z));
}

// The position of a vertex, with the zero signs of its representative if the two are still equal.
fn position_of(vertex: u32, representative: u32) -> V3 {
    if vertex == representative {
        return load_position(vertex);
    }
    return position_of_copy(vertex, representative);
}

fn position_of_copy(vertex: u32, representative: u32) -> V3 {
    let own = load_position(vertex);
    let other = load_position(representative);
    if are_equal(own, other) {
        return other;
    }
    return own;
}
