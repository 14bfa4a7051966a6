// A plan's triangles: what of them does not move.

@group(0) @binding(1) var<storage, read> positions: array<u32>;
@group(0) @binding(2) var<storage, read> normals: array<u32>;
// Five words each: the vertices of the corners with two marks each, and the differences of v along the edges from the first corner.
@group(0) @binding(3) var<storage, read> triangles: array<u32>;
// The vertex that stands for each vertex and its copies.
@group(0) @binding(4) var<storage, read> representatives: array<u32>;

const VERTEX: u32 = 0x3fffffffu;
// Of the first corner: the UV map mirrors the triangle.
const MIRRORS: u32 = 0x80000000u;
// Of the second: the triangle adds nothing; it had two equal positions.
const ADDS_NOTHING: u32 = 0x80000000u;
const IS_DEGENERATE: u32 = 0x40000000u;
// Of the third: some vertex of it is a copy.
const HAS_COPIES: u32 = 0x80000000u;

struct Triangle {
    // Of each corner.
    vertices: vec3u,
    representatives: vec3u,
    marks: vec3u,
    dv: vec2<Real>,
}

fn load_triangle(t: u32) -> Triangle {
    let word = 5u * t;
    let corners = vec3u(triangles[word], triangles[word + 1u], triangles[word + 2u]);
    let own = corners & vec3u(VERTEX);
    var names = own;
    if (corners.z & HAS_COPIES) != 0u {
        names = vec3u(representatives[own.x], representatives[own.y], representatives[own.z]);
    }
    let dv = vec2<Real>(real(triangles[word + 3u]), real(triangles[word + 4u]));
    watch(dv.x);
    watch(dv.y);
    return Triangle(own, names, corners & ~vec3u(VERTEX), dv);
}

fn load_position(vertex: u32) -> V3 {
    let word = vertex * plan.position_stride + plan.position;
    let found = V3(real(positions[word]), real(positions[word + 1u]), real(positions[word + 2u]));
    watch_vector(found);
    return found;
}

fn load_normal(vertex: u32) -> V3 {
    let word = vertex * plan.normal_stride + plan.normal;
    let found = V3(real(normals[word]), real(normals[word + 1u]), real(normals[word + 2u]));
    watch_short_vector(found);
    return found;
}

fn are_equal_words(a: u32, b: u32) -> bool {
    return (a == b || ((a | b) & ~SIGN) == 0u) && !is_nan(a);
}

fn are_equal(a: V3, b: V3) -> bool {
    let x = are_equal_words(word_of(a.x), word_of(b.x));
    let y = are_equal_words(word_of(a.y), word_of(b.y));
    return x && y && are_equal_words(word_of(a.z), word_of(b.z));
}

// The position of a corner: that of its vertex's representative, unless they have moved apart.
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
