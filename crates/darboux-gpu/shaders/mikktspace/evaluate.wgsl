// The frame of every corner: the angle-weighted sum of the terms of its subgroup, normalised. One thread per corner.
//
// The subgroup of a corner is the members of its group whose directions are within the angular threshold. As in the core's
// tangents/mikktspace/evaluate.rs and subgroups.rs, which compute each subgroup once for all its members.

struct Evaluation {
    corner_count: u32,
    // The bits of the cosine of the angular threshold.
    threshold_cosine: u32,
    // 0, but unknown to the compiler.
    opaque_zero: u32,
}

@group(0) @binding(0) var<uniform> evaluation: Evaluation;
// The triangles at each vertex, ascending; the end of each vertex's range; the vertex of each corner.
@group(0) @binding(1) var<storage, read> adjacent_triangles: array<u32>;
@group(0) @binding(2) var<storage, read> adjacency_ends: array<u32>;
@group(0) @binding(3) var<storage, read> vertex_of_corner: array<u32>;
// The first corner of each corner's group.
@group(0) @binding(4) var<storage, read> seed_of_corner: array<u32>;
@group(0) @binding(5) var<storage, read> derivative_of_triangle: array<u32>;
@group(0) @binding(6) var<storage, read> term_of_corner: array<u32>;
// Eight words per corner: tangent, bitangent, magnitudes.
@group(0) @binding(7) var<storage, read_write> frame_of_corner: array<u32>;

const NONE: u32 = 0xffffffffu;
const UV_DEGENERATE: u32 = 2u;
// The triangle before is the other half of the same quad.
const SECOND_HALF: u32 = 8u;
const UNIT_BOUNDED: u32 = 16u;
// Far more than the rounding error of a dot product of such directions.
const MARGIN: f32 = 1e-4;

fn opaque_zero() -> u32 {
    return evaluation.opaque_zero;
}

fn item_count() -> u32 {
    return evaluation.corner_count;
}

struct CornerTerm {
    s: V3,
    t: V3,
    flags: u32,
}

fn term_vector(word: u32) -> V3 {
    return V3(real(term_of_corner[word]), real(term_of_corner[word + 1u]), real(term_of_corner[word + 2u]));
}

fn corner_term(corner: u32) -> CornerTerm {
    let word = 8u * corner;
    return CornerTerm(term_vector(word), term_vector(word + 4u), term_of_corner[word + 7u]);
}

fn approximate_dot(a: V3, b: V3) -> f32 {
    let x = float_of(a.x) * float_of(b.x);
    let y = float_of(a.y) * float_of(b.y);
    return x + y + float_of(a.z) * float_of(b.z);
}

// Whether the tangents and the bitangents of two terms are both within the threshold. An approximate comparison decides nearly all cases.
fn are_near(a: CornerTerm, b: CornerTerm) -> bool {
    let threshold = real(evaluation.threshold_cosine);
    if (a.flags & b.flags & UNIT_BOUNDED) != 0u && !is_nan(evaluation.threshold_cosine) {
        let above = min(approximate_dot(a.s, b.s), approximate_dot(a.t, b.t)) - bitcast<f32>(evaluation.threshold_cosine);
        if abs(above) > MARGIN {
            return above > 0.0;
        }
    } else {
        mark_unsure();
    }
    return is_above(checked_dot3(a.s, b.s), threshold) && is_above(checked_dot3(a.t, b.t), threshold);
}

fn corner_at(triangle: u32, vertex: u32) -> u32 {
    let first = 3u * triangle;
    let is_first = vertex_of_corner[first] == vertex;
    return first + select(select(2u, 1u, vertex_of_corner[first + 1u] == vertex), 0u, is_first);
}

// True for two halves of one quad, and for a triangle and itself.
fn are_same_face(a: u32, a_flags: u32, b: u32, b_flags: u32) -> bool {
    let a_follows = a == b + 1u && (a_flags & SECOND_HALF) != 0u;
    let b_follows = b == a + 1u && (b_flags & SECOND_HALF) != 0u;
    return a == b || a_follows || b_follows;
}

struct Sums {
    s: V3,
    t: V3,
    magnitude: vec2<Real>,
    weight: Real,
}

// Terms in the wide range cannot underflow, so no sum vanishes wrongly.
fn checked_term(weight: Real, direction: V3) -> V3 {
    check_wide_range(direction.x);
    check_wide_range(direction.y);
    check_wide_range(direction.z);
    let term = scale3(weight, direction);
    check_wide_range(term.x);
    check_wide_range(term.y);
    check_wide_range(term.z);
    return term;
}

fn accumulate(sums: ptr<function, Sums>, triangle: u32, corner: u32, own: CornerTerm) {
    let weight = real(term_of_corner[8u * corner + 3u]);
    let of_triangle = 8u * triangle + 6u;
    let s = checked_term(weight, own.s);
    let t = checked_term(weight, own.t);
    let magnitude_x = real(derivative_of_triangle[of_triangle]);
    let magnitude_y = real(derivative_of_triangle[of_triangle + 1u]);
    check_range(weight);
    check_wide_range(magnitude_x);
    check_wide_range(magnitude_y);
    (*sums).s = add3((*sums).s, s);
    (*sums).t = add3((*sums).t, t);
    let x = multiply(weight, magnitude_x);
    let y = multiply(weight, magnitude_y);
    (*sums).magnitude = vec2<Real>(add((*sums).magnitude.x, x), add((*sums).magnitude.y, y));
    (*sums).weight = add((*sums).weight, weight);
}

fn store(corner: u32, sums: Sums) {
    var magnitude = sums.magnitude;
    if is_above(sums.weight, real(0u)) {
        magnitude = vec2<Real>(divide(magnitude.x, sums.weight), divide(magnitude.y, sums.weight));
    }
    check_range3(sums.s);
    check_range3(sums.t);
    let tangent = direction(sums.s);
    let bitangent = direction(sums.t);
    for (var axis = 0u; axis < 3u; axis++) {
        frame_of_corner[8u * corner + axis] = canonical_bits(tangent[axis]);
        frame_of_corner[8u * corner + 3u + axis] = canonical_bits(bitangent[axis]);
    }
    frame_of_corner[8u * corner + 6u] = canonical_bits(magnitude.x);
    frame_of_corner[8u * corner + 7u] = canonical_bits(magnitude.y);
}

fn run(corner: u32) {
    let seed = seed_of_corner[corner];
    if seed == NONE {
        return;
    }
    let vertex = vertex_of_corner[corner];
    var start = 0u;
    if vertex > 0u {
        start = adjacency_ends[vertex - 1u];
    }
    let end = adjacency_ends[vertex];
    let own = corner_term(corner);
    var sums: Sums;
    for (var entry = start; entry < end; entry++) {
        let triangle = adjacent_triangles[entry];
        let member = corner_at(triangle, vertex);
        let other = corner_term(member);
        if seed_of_corner[member] != seed || (other.flags & UV_DEGENERATE) != 0u {
            continue;
        }
        let is_same_face = are_same_face(corner / 3u, own.flags, triangle, other.flags);
        if is_same_face || (own.flags & UV_DEGENERATE) != 0u || are_near(own, other) {
            accumulate(&sums, triangle, member, other);
        }
    }
    store(corner, sums);
}
