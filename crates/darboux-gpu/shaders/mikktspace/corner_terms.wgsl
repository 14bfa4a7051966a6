// The term of every corner: its triangle's derivatives in the plane of the corner's normal, and the corner's angle. One thread per triangle.

@group(0) @binding(3) var<storage, read> derivative_of_triangle: array<u32>;
@group(0) @binding(4) var<storage, read> triangle_flags: array<u32>;
// Eight words per corner: s, the angle, t, flags.
@group(0) @binding(5) var<storage, read_write> term_of_corner: array<u32>;

fn load_derivative(word: u32) -> V3 {
    let found = V3(
        real(derivative_of_triangle[word]),
        real(derivative_of_triangle[word + 1u]),
        real(derivative_of_triangle[word + 2u]),
    );
    check_range3(found);
    return found;
}

// True if no component is larger than those of a rounded unit vector.
fn is_bounded(v: V3) -> bool {
    let size = max(max(bits_of(v.x) & ~SIGN, bits_of(v.y) & ~SIGN), bits_of(v.z) & ~SIGN);
    return size <= ONE + 8u;
}

fn run(t: u32) {
    let corners = vertices_of_triangle(t);
    if corners.x == NONE {
        return;
    }
    let starts = corners * mesh.vertex_stride;
    if (triangle_flags[t] & UV_DEGENERATE) != 0u {
        for (var k = 0u; k < 3u; k++) {
            term_of_corner[8u * (3u * t + k) + 7u] = triangle_flags[t];
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
        check_normal_range3(normal);
        let across_s = direction_in_plane(normal, s);
        let across_t = direction_in_plane(normal, other);
        for (var axis = 0u; axis < 3u; axis++) {
            term_of_corner[out + axis] = bits_of(across_s[axis]);
            term_of_corner[out + 4u + axis] = bits_of(across_t[axis]);
        }
        term_of_corner[out + 3u] = bits_of(angle_between(normal, coming, edges[k]));
        coming = edges[k];
        term_of_corner[out + 7u] = triangle_flags[t] | select(0u, UNIT_BOUNDED, is_bounded(across_s) && is_bounded(across_t));
    }
}

// A flag of corner terms: both directions are short enough for the approximate comparison of evaluate.wgsl.
const UNIT_BOUNDED: u32 = 16u;
