// The derivatives of every triangle: one thread each.

// Eight words each: s, t, magnitudes.
@group(0) @binding(3) var<storage, read_write> derivative_of_triangle: array<u32>;
@group(0) @binding(4) var<storage, read_write> marks: array<u32>;

fn uv_at(start: u32) -> vec2<Real> {
    let found = vec2<Real>(real(vertices[start + mesh.uv]), real(vertices[start + mesh.uv + 1u]));
    watch(found.x);
    watch(found.y);
    return found;
}

fn run(t: u32) {
    let corners = vertices_of_triangle(t);
    if corners.x == NONE {
        marks[t] = 0u;
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
        derivative_of_triangle[8u * t + axis] = stored(found.s[axis]);
        derivative_of_triangle[8u * t + 3u + axis] = stored(found.t[axis]);
    }
    derivative_of_triangle[8u * t + 6u] = stored(found.magnitude.x);
    derivative_of_triangle[8u * t + 7u] = stored(found.magnitude.y);
    marks[t] = select(0u, PRESERVES, found.preserves) | select(0u, ANY, found.any);
}
