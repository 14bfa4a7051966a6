// The neighbour of every triangle across each edge. As in the core's topology/neighbours.rs, with a complete order of edges.
//
// The core visits the half-edges between two vertices in the order of triangles, and pairs each with the first unpaired half-edge of opposite
// direction. So the n-th half-edge of one direction is paired with the n-th of the other. A thread computes n, the number of half-edges
// of its direction in earlier triangles, and skips as many half-edges of the other direction.

@group(0) @binding(3) var<storage, read> adjacent_triangles: array<u32>;
// The triangle across the edges 0-1, 1-2, 2-0.
@group(0) @binding(4) var<storage, read_write> neighbours: array<u32>;
@group(0) @binding(5) var<storage, read_write> is_deferred: array<atomic<u32>>;

fn has_half_edge(triangle: u32, a: u32, b: u32) -> bool {
    let v = vertices_of_triangle(triangle);
    return (v.x == a && v.y == b) || (v.y == a && v.z == b) || (v.z == a && v.x == b);
}

@compute @workgroup_size(WORKGROUP)
fn find_neighbours(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let half_edge = thread_index(thread, groups);
    if half_edge >= 3u * mesh.triangle_count {
        return;
    }
    let triangle = half_edge / 3u;
    let a = vertex_of_corner(half_edge);
    let b = vertex_of_corner(3u * triangle + (half_edge + 1u) % 3u);
    neighbours[half_edge] = NONE;
    if a == NONE {
        return;
    }
    // The ranges of both vertices contain all half-edges between them: use the shorter one.
    let at_a = adjacency_range(a);
    let at_b = adjacency_range(b);
    let range = select(at_b, at_a, at_a.y - at_a.x <= at_b.y - at_b.x);
    if range.y - range.x > MAX_ITERATIONS {
        atomicStore(&is_deferred[a], 1u);
        atomicStore(&is_deferred[b], 1u);
        return;
    }
    var before = 0u;
    for (var entry = range.x; adjacent_triangles[entry] < triangle; entry++) {
        before += u32(has_half_edge(adjacent_triangles[entry], a, b));
    }
    for (var entry = range.x; entry < range.y; entry++) {
        let other = adjacent_triangles[entry];
        if has_half_edge(other, b, a) {
            if before == 0u {
                neighbours[half_edge] = other;
                return;
            }
            before -= 1u;
        }
    }
}
