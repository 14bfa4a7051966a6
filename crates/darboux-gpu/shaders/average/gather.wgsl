// Every vertex looks at its own triangles.

@group(0) @binding(5) var<storage, read> ends: array<u32>;
@group(0) @binding(6) var<storage, read> triangle_of_entry: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn gather(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = number_of_thread(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    var start = 0u;
    if vertex > 0u {
        start = ends[vertex - 1u];
    }
    let end = ends[vertex];
    var sums: Sums;
    if end - start > MAX_TURNS {
        atomicAdd(&counts.past_limit, 1u);
    } else {
        for (var entry = start; entry < end; entry++) {
            add(&sums, vertices_of_triangle(triangle_of_entry[entry]));
        }
    }
    store_frame(vertex, sums);
}
