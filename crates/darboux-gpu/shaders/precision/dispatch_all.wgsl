// Entry point that runs every item.

fn is_postponed() -> bool {
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn every_item(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let item = thread.x + thread.y * groups.x * WORKGROUP;
    if item < item_count() {
        run(item);
    }
}
