// The derivatives of every triangle. One thread per triangle.

// Eight words per triangle: s, t, magnitudes.
@group(0) @binding(3) var<storage, read_write> derivative_of_triangle: array<u32>;
@group(0) @binding(4) var<storage, read_write> triangle_flags: array<u32>;

fn uv_at(start: u32) -> vec2<Real> {
    let found = vec2<Real>(real(vertices[start + mesh.uv]), real(vertices[start + mesh.uv + 1u]));
    check_range(found.x);
    check_range(found.y);
    return found;
}

fn run(t: u32) {
    let corners = vertices_of_triangle(t);
    if corners.x == NONE {
        triangle_flags[t] = 0u;
        return;
    }
    let starts = corners * mesh.vertex_stride;
    let found = derivative(
        load_position(starts.x),
        load_position(starts.y),
        load_position(starts.z),
        uv_at(starts.x),
        uv_at(starts.y),
        uv_at(starts.z),
    );
    for (var axis = 0u; axis < 3u; axis++) {
        derivative_of_triangle[8u * t + axis] = canonical_bits(found.s[axis]);
        derivative_of_triangle[8u * t + 3u + axis] = canonical_bits(found.t[axis]);
    }
    derivative_of_triangle[8u * t + 6u] = canonical_bits(found.magnitude.x);
    derivative_of_triangle[8u * t + 7u] = canonical_bits(found.magnitude.y);
    triangle_flags[t] = select(0u, KEEPS_ORIENTATION, found.keeps_orientation) | select(0u, UV_DEGENERATE, found.uv_degenerate);
}
