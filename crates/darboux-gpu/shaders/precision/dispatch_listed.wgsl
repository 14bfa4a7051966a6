// Entry point that runs the items of a work list.

struct List {
    groups: u32,
    rows: u32,
    layers: u32,
    count: u32,
    items: array<u32>,
}

@group(0) @binding(9) var<storage, read> list: List;

fn is_postponed() -> bool {
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn every_item(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var index = thread.x; index < list.count; index += groups.x * WORKGROUP) {
        run(list.items[index]);
    }
}
