// Reads the adjacency table. In these kernels `indices` are the welded vertices of corners, NONE at degenerate triangles.

@group(0) @binding(2) var<storage, read> adjacency_ends: array<u32>;

// The range of a vertex in `adjacent_triangles`.
fn adjacency_range(vertex: u32) -> vec2u {
    var start = 0u;
    if vertex > 0u {
        start = adjacency_ends[vertex - 1u];
    }
    return vec2u(start, adjacency_ends[vertex]);
}

// The corner of a triangle at a vertex.
fn corner_at(triangle: u32, vertex: u32) -> u32 {
    let v = vertices_of_triangle(triangle);
    return 3u * triangle + select(select(2u, 1u, v.y == vertex), 0u, v.x == vertex);
}
