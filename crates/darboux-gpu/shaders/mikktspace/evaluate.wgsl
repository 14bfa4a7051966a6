// The frame of every corner: the members of its group that join it, weighted by their angles. One thread per corner. The twin of the core's
// tangents/evaluate.rs and subgroups.rs: there a subgroup is summed once for all of its members.

struct Evaluation {
    corner_count: u32,
    // The cosine above which members join, as a word.
    threshold_cosine: u32,
    // 0, which compilers do not know.
    zero: u32,
}

@group(0) @binding(0) var<uniform> evaluation: Evaluation;
// The triangles at each vertex, ascending, vertex after vertex; where the part of each vertex ends; the vertex of each corner.
@group(0) @binding(1) var<storage, read> triangle_of_entry: array<u32>;
@group(0) @binding(2) var<storage, read> ends: array<u32>;
@group(0) @binding(3) var<storage, read> vertex_of_corner: array<u32>;
// The first corner of each corner's group.
@group(0) @binding(4) var<storage, read> seed_of_corner: array<u32>;
@group(0) @binding(5) var<storage, read> derivative_of_triangle: array<u32>;
@group(0) @binding(6) var<storage, read> wedge_of_corner: array<u32>;
// Eight words each: tangent, bitangent, magnitudes.
@group(0) @binding(7) var<storage, read_write> frame_of_corner: array<u32>;

const NONE: u32 = 0xffffffffu;
const ANY: u32 = 2u;
// The triangle before is the other half of its quad.
const SECOND_HALF: u32 = 8u;
const BOUNDED: u32 = 16u;
// Far more than the errors of dot products of what is bounded.
const DOUBT: f32 = 1e-4;

fn zero() -> u32 {
    return evaluation.zero;
}

fn item_count() -> u32 {
    return evaluation.corner_count;
}

struct Wedge {
    s: V3,
    t: V3,
    flags: u32,
}

fn wedge_vector(word: u32) -> V3 {
    return V3(real(wedge_of_corner[word]), real(wedge_of_corner[word + 1u]), real(wedge_of_corner[word + 2u]));
}

fn wedge(corner: u32) -> Wedge {
    let word = 8u * corner;
    return Wedge(wedge_vector(word), wedge_vector(word + 4u), wedge_of_corner[word + 7u]);
}

fn estimate(a: V3, b: V3) -> f32 {
    let x = estimate_of(a.x) * estimate_of(b.x);
    let y = estimate_of(a.y) * estimate_of(b.y);
    return x + y + estimate_of(a.z) * estimate_of(b.z);
}

// Whether two tangents and two bitangents are both nearer than the threshold.
fn are_near(a: Wedge, b: Wedge) -> bool {
    let threshold = real(evaluation.threshold_cosine);
    if (a.flags & b.flags & BOUNDED) != 0u && !is_nan(evaluation.threshold_cosine) {
        let above = min(estimate(a.s, b.s), estimate(a.t, b.t)) - bitcast<f32>(evaluation.threshold_cosine);
        if abs(above) > DOUBT {
            return above > 0.0;
        }
    } else {
        give_up();
    }
    return is_above(watched_dot(a.s, b.s), threshold) && is_above(watched_dot(a.t, b.t), threshold);
}

fn corner_at(triangle: u32, vertex: u32) -> u32 {
    let first = 3u * triangle;
    let is_first = vertex_of_corner[first] == vertex;
    return first + select(select(2u, 1u, vertex_of_corner[first + 1u] == vertex), 0u, is_first);
}

// True for the halves of one quad, and for one triangle.
fn are_of_one_face(a: u32, a_flags: u32, b: u32, b_flags: u32) -> bool {
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

// Of what is wide no sum vanishes that should not.
fn watched_term(weight: Real, direction: V3) -> V3 {
    watch_wide(direction.x);
    watch_wide(direction.y);
    watch_wide(direction.z);
    let term = scaled(weight, direction);
    watch_wide(term.x);
    watch_wide(term.y);
    watch_wide(term.z);
    return term;
}

fn add(sums: ptr<function, Sums>, triangle: u32, corner: u32, own: Wedge) {
    let weight = real(wedge_of_corner[8u * corner + 3u]);
    let of_triangle = 8u * triangle + 6u;
    let s = watched_term(weight, own.s);
    let t = watched_term(weight, own.t);
    let magnitude_x = real(derivative_of_triangle[of_triangle]);
    let magnitude_y = real(derivative_of_triangle[of_triangle + 1u]);
    watch(weight);
    watch_wide(magnitude_x);
    watch_wide(magnitude_y);
    (*sums).s = added((*sums).s, s);
    (*sums).t = added((*sums).t, t);
    let x = times(weight, magnitude_x);
    let y = times(weight, magnitude_y);
    (*sums).magnitude = vec2<Real>(plus((*sums).magnitude.x, x), plus((*sums).magnitude.y, y));
    (*sums).weight = plus((*sums).weight, weight);
}

fn store(corner: u32, sums: Sums) {
    var magnitude = sums.magnitude;
    if is_above(sums.weight, real(0u)) {
        magnitude = vec2<Real>(over(magnitude.x, sums.weight), over(magnitude.y, sums.weight));
    }
    watch_vector(sums.s);
    watch_vector(sums.t);
    let tangent = direction(sums.s);
    let bitangent = direction(sums.t);
    for (var axis = 0u; axis < 3u; axis++) {
        frame_of_corner[8u * corner + axis] = stored(tangent[axis]);
        frame_of_corner[8u * corner + 3u + axis] = stored(bitangent[axis]);
    }
    frame_of_corner[8u * corner + 6u] = stored(magnitude.x);
    frame_of_corner[8u * corner + 7u] = stored(magnitude.y);
}

fn run(corner: u32) {
    let seed = seed_of_corner[corner];
    if seed == NONE {
        return;
    }
    let vertex = vertex_of_corner[corner];
    var start = 0u;
    if vertex > 0u {
        start = ends[vertex - 1u];
    }
    let end = ends[vertex];
    let own = wedge(corner);
    var sums: Sums;
    for (var entry = start; entry < end; entry++) {
        let triangle = triangle_of_entry[entry];
        let member = corner_at(triangle, vertex);
        let other = wedge(member);
        if seed_of_corner[member] != seed || (other.flags & ANY) != 0u {
            continue;
        }
        let is_of_one_face = are_of_one_face(corner / 3u, own.flags, triangle, other.flags);
        if is_of_one_face || (own.flags & ANY) != 0u || are_near(own, other) {
            add(&sums, triangle, member, other);
        }
    }
    store(corner, sums);
}
