// Per vertex and UV orientation, the sum of what the adjacent triangles add: `term_vectors` of unit_terms.wgsl or lengyel_terms.wgsl. The same
// computation as the core's tangents/methods/vertex_sums: terms are added in the order of triangles.

struct Counts {
    without_direction: atomic<u32>,
    of_both_orientations: atomic<u32>,
    past_limit: atomic<u32>,
}

@group(0) @binding(4) var<storage, read_write> counts: Counts;

const MIN_POSITIVE: f32 = 1.17549435e-38;

// Tests the bits, because compilers may assume that floats are finite.
fn is_finite(word: u32) -> bool {
    return (word & 0x7f800000u) != 0x7f800000u;
}

fn not_zero(x: f32) -> bool {
    return abs(x) > MIN_POSITIVE;
}

fn load_normal(vertex: u32) -> vec3u {
    let word = vertex * mesh.vertex_stride + mesh.normal;
    return vec3u(vertices[word], vertices[word + 1u], vertices[word + 2u]);
}

struct Vertex {
    position: vec3f,
    uv: vec2f,
    is_finite: bool,
}

fn load_vertex(vertex: u32) -> Vertex {
    let start = vertex * mesh.vertex_stride;
    let p = start + mesh.position;
    let position = vec3u(vertices[p], vertices[p + 1u], vertices[p + 2u]);
    let uv = vec2u(vertices[start + mesh.uv], vertices[start + mesh.uv + 1u]);
    let positions_are_finite = is_finite(position.x) && is_finite(position.y) && is_finite(position.z);
    let is_finite = positions_are_finite && is_finite(uv.x) && is_finite(uv.y);
    return Vertex(bitcast<vec3f>(position), bitcast<vec2f>(uv), is_finite);
}

const UNMIRRORED: u32 = 0u;
const MIRRORED: u32 = 1u;
const NO_TERM: u32 = 2u;

// What a triangle adds. `size`: the length of the tangent, within a factor of two.
struct TermVectors {
    tangent: vec3f,
    bitangent: vec3f,
    size: f32,
    are_finite: bool,
}

// The term of a triangle, and the orientation whose sum it belongs to.
struct Term {
    vectors: TermVectors,
    side: u32,
}

fn size(v: vec3f) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

// From dP/du and dP/dv (E. Lengyel, "Foundations of Game Engine Development", vol. 2, 7.5). A triangle on which one of them is zero or
// undefined, or with an index out of range, has no term.
fn term_of_triangle(triangle: vec3u) -> Term {
    let nothing = Term(TermVectors(vec3f(), vec3f(), 0.0, false), NO_TERM);
    if any(triangle >= vec3u(mesh.vertex_count)) {
        return nothing;
    }
    let a = load_vertex(triangle.x);
    let b = load_vertex(triangle.y);
    let c = load_vertex(triangle.z);
    let e1 = b.position - a.position;
    let e2 = c.position - a.position;
    let e3 = c.position - b.position;
    let d1 = b.uv - a.uv;
    let d2 = c.uv - a.uv;
    let s = d2.y * e1 - d1.y * e2;
    let t = d1.x * e2 - d2.x * e1;
    // Products are rounded separately, so that the area is exactly 0 if the UVs are collinear.
    let area = rounded(d1.x * d2.y) - rounded(d1.y * d2.x);
    let vectors = term_vectors(s, t, area);
    let values_are_finite = a.is_finite && b.is_finite && c.is_finite;
    let has_corners = size(e1) > 0.0 && size(e2) > 0.0 && size(e3) > 0.0;
    let has_directions = not_zero(area) && size(s) > 0.0 && size(t) > 0.0;
    if !(values_are_finite && vectors.are_finite && has_corners && has_directions) {
        return nothing;
    }
    return Term(vectors, select(MIRRORED, UNMIRRORED, area > 0.0));
}

// `size`: the sum of the terms' sizes. `count`: the number of terms.
struct Sum {
    tangent: vec3f,
    size: f32,
    bitangent: vec3f,
    count: f32,
}

struct Sums {
    unmirrored: Sum,
    mirrored: Sum,
}

fn add_term(sum: Sum, term: TermVectors) -> Sum {
    return Sum(sum.tangent + term.tangent, sum.size + term.size, sum.bitangent + term.bitangent, sum.count + 1.0);
}

fn add_triangle(sums: ptr<function, Sums>, triangle: vec3u) {
    let term = term_of_triangle(triangle);
    if term.side == UNMIRRORED {
        (*sums).unmirrored = add_term((*sums).unmirrored, term.vectors);
    } else if term.side == MIRRORED {
        (*sums).mirrored = add_term((*sums).mirrored, term.vectors);
    }
}
