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
    var at: array<V3, 3>;
    for (var k = 0u; k < 3u; k++) {
        at[k] = position_of(triangle.vertices[k], triangle.representatives[k]);
    }
    let e1 = less(at[1], at[0]);
    let e2 = less(at[2], at[0]);
    watch_vector(e1);
    watch_vector(e2);
    let raw = difference_of_scaled(triangle.dv.y, e1, triangle.dv.x, e2);
    let sign = real(select(ONE, ONE | SIGN, (triangle.marks.x & MIRRORS) != 0u));
    let s = unit_unless_zero(sign, length_of(raw), raw);
    watch_vector(s);
    for (var k = 0u; k < 3u; k++) {
        let normal = load_normal(triangle.representatives[k]);
        let weight = angle_at(normal, at[(k + 2u) % 3u], at[k], at[(k + 1u) % 3u]);
        let term = scaled(weight, direction_in_plane(normal, s));
        let word = 3u * (3u * t + k);
        term_of_corner[word] = stored(term.x);
        term_of_corner[word + 1u] = stored(term.y);
        term_of_corner[word + 2u] = stored(term.z);
    }
}
