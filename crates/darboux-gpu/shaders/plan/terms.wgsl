// What every triangle adds to the sums at its corners: dP/du in the plane of the vertex times the angle there. One thread per triangle.

// Three words for each corner.
@group(0) @binding(5) var<storage, read_write> term_of_corner: array<u32>;

fn item_count() -> u32 {
    return plan.triangle_count;
}

fn run(t: u32) {
    let triangle = load_triangle(t);
    if (triangle.marks.y & ADDS_NOTHING) != 0u {
        return;
    }
    let names = triangle.representatives;
    let a = position_of(triangle.vertices.x, names.x);
    let b = position_of(triangle.vertices.y, names.y);
    let c = position_of(triangle.vertices.z, names.z);
    var edges = edges_of(a, b, c);
    let raw = difference_of_scaled(triangle.dv.y, edges[0], negated(triangle.dv.x), edges[2]);
    let s = unit_unless_zero((triangle.marks.x & MIRRORS) != 0u, length_and_inverse(raw), raw);
    watch_vector_from_below(s);
    var coming = edges[2];
    for (var k = 0u; k < 3u; k++) {
        let normal = load_normal(names[k]);
        let weight = angle_between(normal, coming, edges[k]);
        let term = scaled(weight, direction_in_plane(normal, s));
        let word = 3u * (3u * t + k);
        term_of_corner[word] = word_of(term.x);
        term_of_corner[word + 1u] = word_of(term.y);
        term_of_corner[word + 2u] = word_of(term.z);
        coming = edges[k];
    }
}
