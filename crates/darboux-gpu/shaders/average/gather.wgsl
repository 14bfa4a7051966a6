// Every vertex adds up its own triangles, which it finds in the adjacency table.

@group(0) @binding(5) var<storage, read> adjacency_ends: array<u32>;
@group(0) @binding(6) var<storage, read> adjacent_triangles: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn gather(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = thread_index(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    var start = 0u;
    if vertex > 0u {
        start = adjacency_ends[vertex - 1u];
    }
    let end = adjacency_ends[vertex];
    var sums: Sums;
    if end - start > MAX_ITERATIONS {
        atomicAdd(&counts.past_limit, 1u);
    } else {
        for (var entry = start; entry < end; entry++) {
            add_triangle(&sums, vertices_of_triangle(adjacent_triangles[entry]));
        }
    }
    store_frame(vertex, sums);
}
