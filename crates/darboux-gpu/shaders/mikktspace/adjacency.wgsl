// The triangles at each vertex, ascending, vertex after vertex, and where each vertex's part ends: the core's `adjacency`, by threads.
//
// `count` counts the corners of each vertex, a prefix sum (prefix_sum.wgsl) makes starts of counts, and `scatter` moves these to the ends while it
// fills the parts in whatever order threads come. `rank` puts every entry where the smaller ones of its part leave it: the same
// order on every run.

@group(0) @binding(2) var<storage, read_write> ends: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> corner_of_entry: array<u32>;
@group(0) @binding(4) var<storage, read_write> triangle_of_entry: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn count(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = number_of_thread(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    if vertex < mesh.vertex_count {
        atomicAdd(&ends[vertex], 1u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn scatter(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = number_of_thread(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    if vertex < mesh.vertex_count {
        corner_of_entry[atomicAdd(&ends[vertex], 1u)] = corner;
    }
}

@compute @workgroup_size(WORKGROUP)
fn rank(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entry = number_of_thread(thread, groups);
    // Indices that are out of range leave the last entries unused.
    if entry >= atomicLoad(&ends[mesh.vertex_count - 1u]) {
        return;
    }
    let corner = corner_of_entry[entry];
    let vertex = vertex_of_corner(corner);
    var start = 0u;
    if vertex > 0u {
        start = atomicLoad(&ends[vertex - 1u]);
    }
    let end = atomicLoad(&ends[vertex]);
    if end - start > MAX_TURNS {
        return;
    }
    var place = start;
    for (var other = start; other < end; other++) {
        place += u32(corner_of_entry[other] < corner);
    }
    triangle_of_entry[place] = corner / 3u;
}
