// Every vertex looks at all triangles, a piece of the list after the other.

@group(0) @binding(5) var<storage, read_write> sums_of_vertex: array<Sums>;

// Here `mesh` has the triangles of one piece, at most MAX_TURNS.
@compute @workgroup_size(WORKGROUP)
fn brute_force(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = number_of_thread(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    var sums = sums_of_vertex[vertex];
    for (var t = 0u; t < mesh.triangle_count; t++) {
        let triangle = vertices_of_triangle(t);
        if any(triangle == vec3u(vertex)) {
            add(&sums, triangle);
        }
    }
    sums_of_vertex[vertex] = sums;
}

@compute @workgroup_size(WORKGROUP)
fn store_frames(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = number_of_thread(thread, groups);
    if vertex < mesh.vertex_count {
        store_frame(vertex, sums_of_vertex[vertex]);
    }
}
