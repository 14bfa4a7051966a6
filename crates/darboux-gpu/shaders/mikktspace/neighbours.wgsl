// Which triangles meet at which edges: the twin of the core's topology.rs, with its order of edges complete.
//
// Of the half-edges between two vertices, in the order of triangles, the core lets each take the next free one that runs the opposite way.
// Those that wait all run the same way and are taken in order: so the first one way is with the first the other way, the second
// with the second. A thread counts how many of its way come before its own, and passes as many of the other way.

@group(0) @binding(3) var<storage, read> triangle_of_entry: array<u32>;
// The triangle across the edges 0-1, 1-2, 2-0.
@group(0) @binding(4) var<storage, read_write> neighbours: array<u32>;
@group(0) @binding(5) var<storage, read_write> is_left: array<atomic<u32>>;

fn has_half_edge(triangle: u32, a: u32, b: u32) -> bool {
    let v = vertices_of_triangle(triangle);
    return (v.x == a && v.y == b) || (v.y == a && v.z == b) || (v.z == a && v.x == b);
}

@compute @workgroup_size(WORKGROUP)
fn find_neighbours(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let half_edge = number_of_thread(thread, groups);
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
    // Both ends know all half-edges between them.
    let at_a = entries(a);
    let at_b = entries(b);
    let range = select(at_b, at_a, at_a.y - at_a.x <= at_b.y - at_b.x);
    if range.y - range.x > MAX_TURNS {
        atomicStore(&is_left[a], 1u);
        atomicStore(&is_left[b], 1u);
        return;
    }
    var before = 0u;
    for (var entry = range.x; triangle_of_entry[entry] < triangle; entry++) {
        before += u32(has_half_edge(triangle_of_entry[entry], a, b));
    }
    for (var entry = range.x; entry < range.y; entry++) {
        let other = triangle_of_entry[entry];
        if has_half_edge(other, b, a) {
            if before == 0u {
                neighbours[half_edge] = other;
                return;
            }
            before -= 1u;
        }
    }
}
