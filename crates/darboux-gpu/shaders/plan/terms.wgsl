// The term of every corner: dP/du in the plane of the corner's normal, times the angle of the corner. One thread per triangle.

// Three words per corner.
@group(0) @binding(5) var<storage, read_write> term_of_corner: array<u32>;

fn item_count() -> u32 {
    return plan.triangle_count;
}

fn run(t: u32) {
    let triangle = load_triangle(t);
    if (triangle.flags.y & ADDS_NOTHING) != 0u {
        return;
    }
    let copied_from = triangle.representatives;
    let a = position_of(triangle.vertices.x, copied_from.x);
    let b = position_of(triangle.vertices.y, copied_from.y);
    let c = position_of(triangle.vertices.z, copied_from.z);
    var edges = edges_of(a, b, c);
    let raw = difference_of_scaled(triangle.dv.y, edges[0], negate(triangle.dv.x), edges[2]);
    let s = unit_unless_zero((triangle.flags.x & MIRRORS) != 0u, length_and_inverse(raw), raw);
    check_not_tiny3(s);
    var coming = edges[2];
    for (var k = 0u; k < 3u; k++) {
        let normal = load_normal(copied_from[k]);
        let weight = angle_between(normal, coming, edges[k]);
        let term = scale3(weight, direction_in_plane(normal, s));
        let word = 3u * (3u * t + k);
        term_of_corner[word] = bits_of(term.x);
        term_of_corner[word + 1u] = bits_of(term.y);
        term_of_corner[word + 2u] = bits_of(term.z);
        coming = edges[k];
    }
}
