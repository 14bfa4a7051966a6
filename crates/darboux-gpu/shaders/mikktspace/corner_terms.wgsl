// The wedges of every triangle, at its three corners: one thread per triangle.

@group(0) @binding(3) var<storage, read> derivative_of_triangle: array<u32>;
@group(0) @binding(4) var<storage, read> marks: array<u32>;
// Eight words each: s, the angle, t, marks.
@group(0) @binding(5) var<storage, read_write> wedge_of_corner: array<u32>;

fn load_derivative(word: u32) -> V3 {
    let found = V3(
        real(derivative_of_triangle[word]),
        real(derivative_of_triangle[word + 1u]),
        real(derivative_of_triangle[word + 2u]),
    );
    watch_vector(found);
    return found;
}

// True for what no component of a unit vector is larger than, whatever it was rounded from.
fn is_bounded(v: V3) -> bool {
    let size = max(max(word_of(v.x) & ~SIGN, word_of(v.y) & ~SIGN), word_of(v.z) & ~SIGN);
    return size <= ONE + 8u;
}

fn run(t: u32) {
    let corners = vertices_of_triangle(t);
    if corners.x == NONE {
        return;
    }
    let starts = corners * mesh.vertex_stride;
    if (marks[t] & ANY) != 0u {
        for (var k = 0u; k < 3u; k++) {
            wedge_of_corner[8u * (3u * t + k) + 7u] = marks[t];
        }
        return;
    }
    let s = load_derivative(8u * t);
    let other = load_derivative(8u * t + 3u);
    var edges = edges_of(load_position(starts.x), load_position(starts.y), load_position(starts.z));
    var coming = edges[2];
    for (var k = 0u; k < 3u; k++) {
        let out = 8u * (3u * t + k);
        let normal = vector_at(starts[k] + mesh.normal);
        watch_short_vector(normal);
        let across_s = direction_in_plane(normal, s);
        let across_t = direction_in_plane(normal, other);
        for (var axis = 0u; axis < 3u; axis++) {
            wedge_of_corner[out + axis] = word_of(across_s[axis]);
            wedge_of_corner[out + 4u + axis] = word_of(across_t[axis]);
        }
        wedge_of_corner[out + 3u] = word_of(angle_between(normal, coming, edges[k]));
        coming = edges[k];
        wedge_of_corner[out + 7u] = marks[t] | select(0u, BOUNDED, is_bounded(across_s) && is_bounded(across_t));
    }
}

// Of wedges alone: good for estimates.
const BOUNDED: u32 = 16u;
