// Every item in turn, with whatever precision.

fn is_left() -> bool {
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn every_item(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let item = thread.x + thread.y * groups.x * WORKGROUP;
    if item < item_count() {
        run(item);
    }
}
