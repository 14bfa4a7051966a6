// The triangles at each vertex, ascending, as one array with the end of each vertex's range.
//
//     count     counts the corners of each vertex
//     (a prefix sum turns the counts into the starts of ranges)
//     scatter   writes corners into the ranges, in an order that depends on timing; the starts become ends
//     rank      sorts each range: the position of a corner is the number of smaller corners in its range

@group(0) @binding(2) var<storage, read_write> adjacency_ends: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> adjacent_corners: array<u32>;
@group(0) @binding(4) var<storage, read_write> adjacent_triangles: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn count(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    if vertex < mesh.vertex_count {
        atomicAdd(&adjacency_ends[vertex], 1u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn scatter(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    if vertex < mesh.vertex_count {
        adjacent_corners[atomicAdd(&adjacency_ends[vertex], 1u)] = corner;
    }
}

@compute @workgroup_size(WORKGROUP)
fn rank(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entry = thread_index(thread, groups);
    // Corners with an index out of range are not listed, so the last entries are unused.
    if entry >= atomicLoad(&adjacency_ends[mesh.vertex_count - 1u]) {
        return;
    }
    let corner = adjacent_corners[entry];
    let vertex = vertex_of_corner(corner);
    var start = 0u;
    if vertex > 0u {
        start = atomicLoad(&adjacency_ends[vertex - 1u]);
    }
    let end = atomicLoad(&adjacency_ends[vertex]);
    if end - start > MAX_ITERATIONS {
        return;
    }
    var place = start;
    for (var other = start; other < end; other++) {
        place += u32(adjacent_corners[other] < corner);
    }
    adjacent_triangles[place] = corner / 3u;
}
