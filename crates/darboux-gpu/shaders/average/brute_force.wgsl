// Every vertex tests all triangles. One dispatch handles one range of triangles and adds to the sums that the buffer holds.

@group(0) @binding(5) var<storage, read_write> sums_of_vertex: array<Sums>;

// `mesh` describes the triangles of one range, at most MAX_ITERATIONS.
@compute @workgroup_size(WORKGROUP)
fn brute_force(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = thread_index(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    var sums = sums_of_vertex[vertex];
    for (var t = 0u; t < mesh.triangle_count; t++) {
        let triangle = vertices_of_triangle(t);
        if any(triangle == vec3u(vertex)) {
            add_triangle(&sums, triangle);
        }
    }
    sums_of_vertex[vertex] = sums;
}

@compute @workgroup_size(WORKGROUP)
fn store_frames(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = thread_index(thread, groups);
    if vertex < mesh.vertex_count {
        store_frame(vertex, sums_of_vertex[vertex]);
    }
}
